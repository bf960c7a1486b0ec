// SPDX-License-Identifier: Apache-2.0
// Lists of variables and constants.
#include "dsp/core/error.hpp"
#include "graph/formula/formula.hpp"
#include "graph/formula/scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace tactus::formula {

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

struct Amount {
    double value = 0.0;  ///< SI
    Measure measure;
};

/// "0.8 N/mm"; nothing when `text` is no number with a unit.
std::optional<Amount> amount_of(std::string_view text) {
    Amount amount;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), amount.value);
    if (failure != std::errc{}) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const MeasuredUnit unit = parse_measured_unit(trimmed(text));
    amount.value *= unit.factor;
    amount.measure = unit.measure;
    return amount;
}

/// "m from 0 mm to 5 mm": takes the range off and gives it to the variable.
void take_range(std::string_view& entry, Variable& variable) {
    const std::string_view whole = entry;
    constexpr std::string_view from = "from ", to = " to ";
    std::size_t at = entry.starts_with(from) ? 0 : entry.find(" from ");
    if (at == entry.npos) return;
    at += at > 0;
    const std::string_view range = entry.substr(at + from.size());
    entry = trimmed(entry.substr(0, at));
    const std::size_t middle = range.find(to);
    if (middle != range.npos) {
        const auto low = amount_of(trimmed(range.substr(0, middle))),
                   high = amount_of(trimmed(range.substr(middle + to.size())));
        const Measure measure = parse_measured_unit(entry).measure;
        if (low && high && low->measure == measure && high->measure == measure && low->value <= high->value &&
            std::isfinite(low->value) && std::isfinite(high->value)) {
            variable.range = {low->value, high->value};
            return;
        }
    }
    throw Error(fmt::format("'{} {}' needs a range in its own unit, as in \"depth m from 0 mm to 5 mm\"", variable.name,
                            whole));
}

}  // namespace

std::vector<Variable> parse_variables(std::string_view text) {
    std::vector<Variable> variables;
    for_each_entry(text, [&](std::string_view entry) {
        Variable variable;
        variable.name = take_name(entry);
        need_new(variables, variable.name);
        take_range(entry, variable);
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
        const std::optional<Amount> amount = amount_of(entry);
        if (!amount) throw Error(fmt::format("'{}' needs a value, as in \"k = 0.8 N/mm\"", whole));
        constant.value = amount->value;
        constant.measure = amount->measure;
        if (!std::isfinite(constant.value)) throw Error(fmt::format("'{}' is out of range", whole));
        constants.push_back(std::move(constant));
    });
    return constants;
}

}  // namespace tactus::formula
