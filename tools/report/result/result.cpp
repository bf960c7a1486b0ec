// SPDX-License-Identifier: Apache-2.0
#include "tools/report/result/result.hpp"

#include "dsp/core/readable.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

constexpr const char* dash = "–";

template <class... Each>
struct Overload : Each... {
    using Each::operator()...;
};
template <class... Each>
Overload(Each...) -> Overload<Each...>;

std::string digits_of(double value, const NumberFormat& format) {
    if (!std::isfinite(value)) return dash;
    const double scaled = value * format.scale;
    if (format.notation == NumberFormat::Notation::fixed) {
        std::string text = fmt::format("{:.{}f}", scaled, format.digits);
        // Not "-0.0".
        if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') text.erase(0, 1);
        return text;
    }
    return plain(scaled, format.digits);
}

std::string with_unit(std::string digits, const std::string& unit) {
    if (unit.empty() || digits == dash) return digits;
    return digits + (unit == "°" ? "" : " ") + unit;
}

std::string shown_number(const Number& number, const NumberFormat& format) {
    if (!number.value || !std::isfinite(*number.value)) return dash;
    const std::string& unit = number.unit.empty() ? format.unit : number.unit;
    const auto one = [&](double value) {
        return format.notation == NumberFormat::Notation::prefixed ? readable(value, unit, format.digits)
                                                                   : with_unit(digits_of(value, format), unit);
    };
    return number.uncertainty ? fmt::format("{} ± {}", one(*number.value), one(*number.uncertainty))
                              : one(*number.value);
}

}  // namespace

const ResultEntry* Result::find(std::string_view key) const {
    const auto found = std::ranges::find(entries, key, &ResultEntry::key);
    return found == entries.end() ? nullptr : &*found;
}

std::string shown(const ResultEntry& entry) {
    return std::visit(
        Overload{[](const ResultEntry::Quantity& q) { return shown_number(q.number, q.format); },
                 [](const ResultEntry::Range& r) {
                     return r.ends ? with_unit(digits_of(r.ends->first, r.format) + " to " +
                                                   digits_of(r.ends->second, r.format),
                                               r.format.unit)
                                   : std::string(dash);
                 },
                 [](const ResultEntry::Integer& i) { return i.value ? std::to_string(*i.value) : std::string(dash); },
                 [](const ResultEntry::Text& t) { return t.text && !t.text->empty() ? *t.text : std::string(dash); },
                 [](const ResultEntry::Flag& f) {
                     return std::string(!f.value ? dash : *f.value ? "yes" : "no");
                 },
                 [](const ResultEntry::Texts& t) {
                     return t.texts.empty() ? std::string(dash) : fmt::format("{}", fmt::join(t.texts, ", "));
                 },
                 [](const auto&) { return std::string(); }},
        entry.value);
}

bool is_missing(const ResultEntry& entry) {
    return std::visit(Overload{[](const ResultEntry::Quantity& q) { return !q.number.value; },
                               [](const ResultEntry::Range& r) { return !r.ends; },
                               [](const ResultEntry::Integer& i) { return !i.value; },
                               [](const ResultEntry::Text& t) { return !t.text || t.text->empty(); },
                               [](const ResultEntry::Flag& f) { return !f.value; },
                               [](const ResultEntry::Texts& t) { return t.texts.empty(); },
                               [](const ResultEntry::Series& s) { return s.size == 0; },
                               [](const ResultEntry::Picture& p) { return !p.draw; },
                               [](const ResultEntry::Rows& r) { return r.rows.empty(); },
                               [](const ResultEntry::Children& c) { return c.results.empty(); }},
                      entry.value);
}

}  // namespace tactus::report
