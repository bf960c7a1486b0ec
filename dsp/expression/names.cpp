// SPDX-License-Identifier: Apache-2.0
// Lists of variables and constants.
#include "dsp/core/error.hpp"
#include "dsp/expression/formula.hpp"
#include "dsp/expression/scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tactus::expression {

namespace {

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

/// Calls `take` with each entry between commas. An empty text has none.
template <class Take>
void for_each_entry(std::string_view text, Take&& take) {
    if (trimmed(text).empty()) return;
    for (;;) {
        const std::size_t comma = text.find(',');
        const std::string_view entry = trimmed(text.substr(0, comma));
        if (entry.empty()) throw Error("there is nothing between two commas");
        take(entry);
        if (comma == std::string_view::npos) return;
        text.remove_prefix(comma + 1);
    }
}

/// The name that an entry begins with; it is taken off.
std::string take_name(std::string_view& entry) {
    const std::string_view name = name_ahead(entry);
    if (name.empty()) throw Error(fmt::format("'{}' does not begin with a name", entry));
    for (const std::string_view word : {"and", "or", "not", "if"})
        if (name == word) throw Error(fmt::format("'{}' is a word of formulas; choose another name", name));
    entry.remove_prefix(name.size());
    entry = trimmed(entry);
    return std::string(name);
}

template <class Named>
void need_new(const std::vector<Named>& names, const std::string& name) {
    if (std::ranges::find(names, name, &Named::name) != names.end())
        throw Error(fmt::format("'{}' is named twice", name));
}

}  // namespace

std::vector<Variable> parse_variables(std::string_view text) {
    std::vector<Variable> variables;
    for_each_entry(text, [&](std::string_view entry) {
        Variable variable;
        variable.name = take_name(entry);
        need_new(variables, variable.name);
        variable.unit = entry;
        variable.measure = parse_measured_unit(entry).measure;
        variables.push_back(std::move(variable));
    });
    return variables;
}

std::vector<Constant> parse_constants(std::string_view text) {
    std::vector<Constant> constants;
    for_each_entry(text, [&](std::string_view entry) {
        Constant constant;
        const std::string_view whole = entry;
        constant.name = take_name(entry);
        need_new(constants, constant.name);
        if (!entry.starts_with("=")) throw Error(fmt::format("'{}' needs a value, as in \"k = 0.8 N/mm\"", whole));
        entry = trimmed(entry.substr(1));
        const auto [end, failure] = std::from_chars(entry.data(), entry.data() + entry.size(), constant.value);
        if (failure != std::errc{}) throw Error(fmt::format("'{}' needs a value, as in \"k = 0.8 N/mm\"", whole));
        entry.remove_prefix(static_cast<std::size_t>(end - entry.data()));
        const MeasuredUnit unit = parse_measured_unit(trimmed(entry));
        constant.value *= unit.factor;
        constant.measure = unit.measure;
        if (!std::isfinite(constant.value)) throw Error(fmt::format("'{}' is out of range", whole));
        constants.push_back(std::move(constant));
    });
    return constants;
}

}  // namespace tactus::expression
