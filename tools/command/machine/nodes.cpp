// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "dsp/core/units.hpp"
#include "nodes/catalogue.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace tactus::command {

using file::Json;

namespace {

/// "any", or "number, vector or wrench".
std::string several(const Input& port) { return port.takes == kinds::every ? "any" : type_names(port.takes); }

class Describer : public MemberVisitor {
public:
    Json ports_in = Json::array(), ports_out = Json::array(), parameters = Json::array();

    void input(std::string_view name, Input& port) override {
        std::string type = port.type ? std::string(port.type->name) : several(port);
        if (port.kind == InputKind::batch) type = "batch of " + type;
        ports_in.push_back({{"name", name},
                            {"type", type},
                            {"optional", port.is_optional},
                            {"unit", port.unit},
                            {"about", port.about}});
    }
    void output(std::string_view name, Output& port) override {
        ports_out.push_back({{"name", name}, {"type", port.type->name}, {"unit", port.unit}, {"about", port.about}});
    }
    void param(std::string_view name, Param& p) override {
        parameters.push_back({{"name", name},
                              {"kind", "quantity"},
                              {"default", format_quantity(p.value, p.unit)},
                              {"min", format_quantity(p.min, p.unit)},
                              {"max", format_quantity(p.max, p.unit)},
                              {"live", !p.is_structural},
                              {"about", p.about}});
    }
    void choice(std::string_view name, Choice& c) override {
        parameters.push_back({{"name", name},
                              {"kind", "choice"},
                              {"default", c.options.front()},
                              {"options", c.options},
                              {"about", c.about}});
    }
    void text(std::string_view name, Text& t) override {
        parameters.push_back({{"name", name}, {"kind", "text"}, {"default", t.value}, {"about", t.about}});
    }
    void flag(std::string_view name, Flag& f) override {
        parameters.push_back({{"name", name}, {"kind", "flag"}, {"default", f.value}, {"about", f.about}});
    }
    void vector(std::string_view name, Vector& v) override {
        parameters.push_back(
            {{"name", name},
             {"kind", "vector"},
             {"default", fmt::format("[{}, {}, {}]", format_quantity(v.value.x, v.unit),
                                     format_quantity(v.value.y, v.unit), format_quantity(v.value.z, v.unit))},
             {"unit", v.unit},
             {"about", v.about}});
    }
    void asset(std::string_view name, AssetParam& a) override {
        parameters.push_back({{"name", name},
                              {"kind", "asset"},
                              {"asset", a.type_name},
                              {"optional", a.is_optional},
                              {"about", a.about}});
    }
};

Json describe(const NodeType& type) {
    const compile::NodeInstance node(type.create(), type.destroy);
    Describer describer;
    type.visit(node.get(), describer);
    return {{"type", type.name},
            {"about", type.about},
            {"inputs", describer.ports_in},
            {"outputs", describer.ports_out},
            {"parameters", describer.parameters}};
}

std::string text_of(const Json& json, const char* key) {
    return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
}

/// What a parameter may be, and what it is when the patch does not say.
std::string values_of(const Json& parameter) {
    const std::string kind = text_of(parameter, "kind"), standard = text_of(parameter, "default");
    if (kind == "quantity")
        return fmt::format("{} [{} … {}]{}", standard, text_of(parameter, "min"), text_of(parameter, "max"),
                           parameter["live"].get<bool>() ? "" : " structural");
    if (kind == "flag") return parameter["default"].get<bool>() ? "true [true, false]" : "false [true, false]";
    if (kind == "choice")
        return fmt::format("{} [{}]", standard, fmt::join(parameter["options"].get<std::vector<std::string>>(), ", "));
    if (kind == "text") return fmt::format("text \"{}\"", standard);
    if (kind == "asset")
        return fmt::format("{} of [assets]{}", text_of(parameter, "asset"),
                           parameter["optional"].get<bool>() ? ", optional" : "");
    return standard;
}

void print_whole(const Json& node) {
    fmt::print("{}\n  {}\n", text_of(node, "type"), text_of(node, "about"));
    for (const auto& [title, key] : {std::pair{"in", "inputs"}, {"out", "outputs"}})
        for (const Json& port : node[key])
            fmt::print("  {:>3}  {:<18} {:<16} {}{}{}\n", title, text_of(port, "name"), text_of(port, "type"),
                       text_of(port, "about"), text_of(port, "unit").empty() ? "" : ", " + text_of(port, "unit"),
                       port.value("optional", false) ? " (optional)" : "");
    for (const Json& p : node["parameters"])
        fmt::print("  set  {:<18} {}  {}\n", text_of(p, "name"), values_of(p), text_of(p, "about"));
}

int nodes(const std::string& wanted, bool json) {
    Json list = Json::array();
    std::vector<std::string> names;
    for (const NodeType* type : nodes::catalogue()) {
        names.push_back(type->name);
        if (wanted.empty() || type->name == wanted) list.push_back(describe(*type));
    }
    if (list.empty()) throw Error(fmt::format("no node type '{}'{}", wanted, did_you_mean(wanted, names)));
    if (json) fmt::print("{}\n", Json{{"version", 1}, {"rows", list}}.dump(2));
    else if (!wanted.empty()) print_whole(list[0]);
    else
        for (const Json& node : list) fmt::print("{:<16} {}\n", text_of(node, "type"), text_of(node, "about"));
    return done;
}

Action declare_nodes(VerbOptions& verb) {
    struct Choice {
        std::string type;
        bool json = false;
    };
    const auto choice = std::make_shared<Choice>();
    verb.add("type", choice->type, "only this type");
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return nodes(choice->type, choice->json); };
}

}  // namespace

Verb nodes_verb() { return {"nodes", "list the node types with ports, parameters, units and ranges", declare_nodes}; }

}  // namespace tactus::command
