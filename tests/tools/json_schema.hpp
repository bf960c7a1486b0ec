// SPDX-License-Identifier: Apache-2.0
// JSON outputs beside their schemas.
#pragma once

#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace tactus::test {

/// The first rule of a schema that a value breaks; empty: none. It knows the parts of JSON Schema that outputs use: type,
/// properties, required, additionalProperties, items, const, anyOf.
inline std::string broken_rule(const nlohmann::json& schema, const nlohmann::json& value, const std::string& where) {
    const auto is = [&](const std::string& type) {
        return type == "null"      ? value.is_null()
               : type == "number"  ? value.is_number()
               : type == "integer" ? value.is_number_integer()
               : type == "string"  ? value.is_string()
               : type == "boolean" ? value.is_boolean()
               : type == "array"   ? value.is_array()
                                   : value.is_object();
    };
    if (schema.contains("const") && value != schema["const"]) return where + ": not the constant";
    if (schema.contains("anyOf")) {
        for (const nlohmann::json& one : schema["anyOf"])
            if (broken_rule(one, value, where).empty()) return {};
        return where + ": none of the kinds";
    }
    if (!schema.contains("type")) return {};
    const nlohmann::json types = schema["type"].is_array() ? schema["type"] : nlohmann::json::array({schema["type"]});
    if (std::ranges::none_of(types, [&](const nlohmann::json& type) { return is(type.get<std::string>()); }))
        return where + ": " + value.dump() + " is not " + types.dump();
    if (value.is_array() && schema.contains("items"))
        for (std::size_t n = 0; n < value.size(); ++n)
            if (const std::string rule = broken_rule(schema["items"], value[n], where + "." + std::to_string(n));
                !rule.empty())
                return rule;
    if (!value.is_object()) return {};
    for (const nlohmann::json& key : schema.value("required", nlohmann::json::array()))
        if (!value.contains(key.get<std::string>())) return where + ": without " + key.dump();
    for (const auto& [key, one] : value.items()) {
        if (!schema.contains("properties") || !schema["properties"].contains(key)) {
            // Members of any name: their schema.
            if (!schema["additionalProperties"].is_object()) return where + ": unknown " + key;
            if (const std::string rule = broken_rule(schema["additionalProperties"], one, where + "." + key);
                !rule.empty())
                return rule;
            continue;
        }
        if (const std::string rule = broken_rule(schema["properties"][key], one, where + "." + key); !rule.empty())
            return rule;
    }
    return {};
}

/// The rule of the schema of `verb` that its output breaks; empty: none.
inline std::string broken_schema(const Folder& folder, const std::string& verb, const nlohmann::json& output) {
    const fs::path schemas = folder.path / "schemas", file = schemas / (verb + ".schema.json");
    if (!fs::exists(file) && folder.tactus("generate schema " + schemas.string()).code != 0) return "no schemas";
    if (!fs::exists(file)) return "no schema of " + verb;
    return broken_rule(nlohmann::json::parse(slurp(file)), output, verb);
}

}  // namespace tactus::test
