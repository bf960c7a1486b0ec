// SPDX-License-Identifier: Apache-2.0
#include "graph/node/options.hpp"

#include "dsp/core/units.hpp"
#include "graph/node/unit_of.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace tactus {
Options::Options(std::string owner, std::vector<OptionText> given, SourceLocation where)
    : owner_(std::move(owner)), given_(std::move(given)), where_(std::move(where)) {}

const OptionText* Options::find(std::string_view name) const {
    const auto found = std::find_if(given_.begin(), given_.end(), [&](const OptionText& o) { return o.name == name; });
    return found == given_.end() ? nullptr : &*found;
}

const OptionText* Options::ask(std::string_view name) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.emplace_back(name);
    return find(name);
}

void Options::fail(const OptionText& option, const std::string& message) const {
    throw Error(option.where, fmt::format("{}: option '{}' {}", owner_, option.name, message));
}

double Options::quantity(std::string_view name, std::string_view standard, std::string_view min, std::string_view max) {
    const std::string_view unit = unit_of(standard);
    const OptionText* given = ask(name);
    if (given == nullptr) return parse_as(standard, unit);
    double value = 0.0;
    try {
        value = parse_as(given->text, unit);
    } catch (const Error& error) {
        fail(*given, "cannot be read: " + error.message());
    }
    const bool low = !min.empty() && value < parse_as(min, unit);
    const bool high = !max.empty() && value > parse_as(max, unit);
    if (low || high || !std::isfinite(value)) {
        const std::string range = min.empty() && max.empty() ? std::string("be finite")
                                  : max.empty()              ? fmt::format("be at least {}", min)
                                  : min.empty()              ? fmt::format("be at most {}", max)
                                                             : fmt::format("lie between {} and {}", min, max);
        fail(*given, fmt::format("is {}; it must {} (default {})", given->text, range, standard));
    }
    return value;
}

std::string Options::text(std::string_view name, std::string_view standard) {
    const OptionText* given = ask(name);
    return given == nullptr ? std::string(standard) : given->text;
}

bool Options::flag(std::string_view name, bool standard) {
    const OptionText* given = ask(name);
    if (given == nullptr) return standard;
    if (given->text == "true") return true;
    if (given->text != "false") fail(*given, fmt::format("is '{}'; write true or false", given->text));
    return false;
}

std::size_t Options::choice(std::string_view name, std::span<const std::string> choices, std::string_view standard) {
    const OptionText* given = ask(name);
    const std::string_view wanted = given == nullptr ? standard : std::string_view(given->text);
    const auto found = std::find(choices.begin(), choices.end(), wanted);
    if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
    if (given == nullptr) throw Error(where_, fmt::format("{}: '{}' is no choice of '{}'", owner_, wanted, name));
    fail(*given,
         fmt::format("is '{}'{}; choose one of: {}", wanted, did_you_mean(wanted, choices), fmt::join(choices, ", ")));
}

bool Options::has(std::string_view name) const { return find(name) != nullptr; }

const SourceLocation& Options::where(std::string_view name) const {
    const OptionText* given = find(name);
    return given == nullptr ? where_ : given->where;
}

void Options::finish() const {
    for (const OptionText& option : given_) {
        if (std::find(known_.begin(), known_.end(), option.name) != known_.end()) continue;
        const std::string exist =
            known_.empty() ? std::string("it has none") : fmt::format("it has: {}", fmt::join(known_, ", "));
        throw Error(option.where, fmt::format("{} has no option '{}'{}; {}", owner_, option.name,
                                              did_you_mean(option.name, known_), exist));
    }
}

}  // namespace tactus
