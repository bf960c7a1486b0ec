// SPDX-License-Identifier: Apache-2.0
#include "tools/report/result/result.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/overload.hpp"
#include "dsp/core/readable.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

constexpr const char* dash = "–";

/// Shown number per value.
double scale_of(const std::string& unit, const std::string& of) {
    if (of.empty() || of == unit) return 1.0;
    if (unit == "%" && of == "1") return 100.0;
    const Unit to = parse_unit(unit), from = parse_unit(of);
    if (to.dimension != from.dimension) throw Error(fmt::format("{} is no unit for a value in {}", unit, of));
    return from.factor / to.factor;
}

NumberFormat format_of(NumberFormat::Notation notation, int digits, std::string unit, std::string of) {
    const double scale = scale_of(unit, of);
    return {notation, digits, std::move(unit), std::move(of), scale};
}

std::string unsigned_digits(double value, const NumberFormat& format) {
    const double scaled = value * format.scale;
    if (format.notation == NumberFormat::Notation::fixed) {
        std::string text = fmt::format("{:.{}f}", scaled, format.digits);
        // Not "-0.0".
        if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') text.erase(0, 1);
        return text;
    }
    return plain(scaled, format.digits);
}

std::string digits_of(double value, const NumberFormat& format) {
    if (!std::isfinite(value)) return dash;
    std::string text = unsigned_digits(value, format);
    const bool is_zero = text.find_first_not_of("0.") == std::string::npos;
    return format.is_signed && !is_zero && text.front() != '-' ? "+" + text : text;
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

NumberFormat NumberFormat::with_sign() const {
    NumberFormat format = *this;
    format.is_signed = true;
    return format;
}

NumberFormat fixed(int digits, std::string unit, std::string of) {
    return format_of(NumberFormat::Notation::fixed, digits, std::move(unit), std::move(of));
}
NumberFormat significant(int digits, std::string unit, std::string of) {
    return format_of(NumberFormat::Notation::significant, digits, std::move(unit), std::move(of));
}
NumberFormat from_si(int digits, std::string unit) {
    NumberFormat format = fixed(digits, std::move(unit));
    format.per_si = 1.0 / parse_unit(format.unit).factor;
    return format;
}
NumberFormat prefixed(int digits, std::string unit) {
    return {NumberFormat::Notation::prefixed, digits, std::move(unit)};
}

const ResultEntry* Result::find(std::string_view key) const {
    const auto found = std::ranges::find(entries, key, &ResultEntry::key);
    return found == entries.end() ? nullptr : &*found;
}

ResultEntry::Series series_of(const std::vector<Vec3>& points, double unit) {
    return {3 * points.size(), [&points, unit](std::size_t n) { return points[n / 3][static_cast<int>(n % 3)] / unit; },
            3};
}

void settle_pictures(Result& result, bool keeps_pictures, const FigureStyle& style) {
    for (ResultEntry& entry : result.entries) {
        if (auto* picture = std::get_if<ResultEntry::Picture>(&entry.value); picture && picture->draw) {
            if (!keeps_pictures) picture->draw = nullptr;
            else picture->draw = [drawn = picture->draw(style)](const FigureStyle&) { return drawn; };
        } else if (auto* pictures = std::get_if<ResultEntry::Pictures>(&entry.value); pictures && pictures->make) {
            if (!keeps_pictures) pictures->make = nullptr;
            else pictures->make = [made = pictures->make()] { return made; };
        } else if (auto* children = std::get_if<ResultEntry::Children>(&entry.value)) {
            for (Result& one : children->results) settle_pictures(one, keeps_pictures, style);
        }
    }
}

std::string shown(const ResultEntry& entry) {
    return std::visit(
        Overload{[](const ResultEntry::Quantity& q) { return shown_number(q.number, q.format); },
                 [](const ResultEntry::Numbers& n) {
                     if (!n.values) return std::string(dash);
                     std::vector<std::string> all;
                     for (const auto& value : *n.values)
                         all.push_back(value ? digits_of(*value, n.format) : std::string(dash));
                     return with_unit(fmt::format("{}", fmt::join(all, n.between)), n.format.unit);
                 },
                 [](const ResultEntry::Integer& i) { return i.value ? std::to_string(*i.value) : std::string(dash); },
                 [](const ResultEntry::Integers& i) {
                     return i.values.empty() ? std::string(dash) : fmt::format("{}", fmt::join(i.values, " "));
                 },
                 [](const ResultEntry::Text& t) { return t.text && !t.text->empty() ? *t.text : std::string(dash); },
                 [](const ResultEntry::Flag& f) {
                     return std::string(!f.value ? dash : *f.value ? "yes" : "no");
                 },
                 [](const ResultEntry::Texts& t) {
                     return t.texts.empty() ? std::string(dash) : fmt::format("{}", fmt::join(t.texts, ", "));
                 },
                 [](const ResultEntry::Groups& g) {
                     std::vector<std::string> lines;
                     for (const auto& group : g.groups) lines.push_back(fmt::format("{}", fmt::join(group, ", ")));
                     return lines.empty() ? std::string(dash) : fmt::format("{}", fmt::join(lines, "; "));
                 },
                 [](const auto&) { return std::string(); }},
        entry.value);
}

std::string_view unit_of_value(const ResultEntry& entry) {
    const auto of_format = [](const NumberFormat& format) -> std::string_view {
        return format.of.empty() ? format.unit : format.of == "1" ? std::string_view() : format.of;
    };
    if (const auto* q = std::get_if<ResultEntry::Quantity>(&entry.value))
        return q->number.unit.empty() ? of_format(q->format) : q->number.unit;
    if (const auto* n = std::get_if<ResultEntry::Numbers>(&entry.value)) return of_format(n->format);
    return {};
}

bool is_missing(const ResultEntry& entry) {
    return std::visit(Overload{[](const ResultEntry::Quantity& q) { return !q.number.value; },
                               [](const ResultEntry::Numbers& n) { return !n.values; },
                               [](const ResultEntry::Integer& i) { return !i.value; },
                               [](const ResultEntry::Integers& i) { return i.values.empty(); },
                               [](const ResultEntry::Text& t) { return !t.text || t.text->empty(); },
                               [](const ResultEntry::Flag& f) { return !f.value; },
                               [](const ResultEntry::Texts& t) { return t.texts.empty(); },
                               [](const ResultEntry::Groups& g) { return g.groups.empty(); },
                               [](const ResultEntry::Remark& r) { return r.text.empty(); },
                               [](const ResultEntry::Series& s) { return s.size == 0; },
                               [](const ResultEntry::Picture& p) { return !p.draw; },
                               [](const ResultEntry::Pictures& p) { return !p.make; },
                               [](const ResultEntry::Rows& r) { return r.rows.empty(); },
                               [](const ResultEntry::Children& c) { return c.results.empty(); }},
                      entry.value);
}

}  // namespace tactus::report
