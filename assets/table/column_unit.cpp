// SPDX-License-Identifier: Apache-2.0
#include "assets/table/column_unit.hpp"

#include "assets/table/log_lines.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace tactus::table {

namespace {

constexpr double gravity = 9.80665;  // m/s², standard

/// Spellings that parse_unit does not know.
constexpr std::array<std::pair<std::string_view, std::string_view>, 38> spellings{{
    {"m/s2", "m/s^2"},   {"m/s/s", "m/s^2"},   {"ms-2", "m/s^2"},      {"m/s**2", "m/s^2"},   {"ms^-2", "m/s^2"},
    {"m s-2", "m/s^2"},  {"m s^-2", "m/s^2"},  {"m/sec^2", "m/s^2"},   {"m/sec2", "m/s^2"},   {"m/sec²", "m/s^2"},
    {"mm/s2", "mm/s^2"}, {"mm/sec", "mm/s"},   {"m/sec", "m/s"},       {"volt", "V"},         {"volts", "V"},
    {"millivolt", "mV"}, {"millivolts", "mV"}, {"sec", "s"},           {"secs", "s"},         {"second", "s"},
    {"seconds", "s"},    {"sek", "s"},         {"msec", "ms"},         {"millisecond", "ms"}, {"milliseconds", "ms"},
    {"millis", "ms"},    {"usec", "us"},       {"microseconds", "us"}, {"micros", "us"},      {"newton", "N"},
    {"pascal", "Pa"},    {"µm/s2", "um/s^2"},  {"m·s⁻²", "m/s^2"},     {"m s⁻²", "m/s^2"},    {"m·s-2", "m/s^2"},
    {"m.s-2", "m/s^2"},  {"m*s^-2", "m/s^2"},  {"cm/s2", "cm/s^2"},
}};

/// Standard gravity, which parse_unit takes as the gram, and units that are not of the SI: in m/s².
constexpr std::array<std::pair<std::string_view, double>, 23> accelerations{{{"g", gravity},
                                                                             {"G", gravity},
                                                                             {"gn", gravity},
                                                                             {"g0", gravity},
                                                                             {"gs", gravity},
                                                                             {"g's", gravity},
                                                                             {"Gs", gravity},
                                                                             {"gee", gravity},
                                                                             {"gees", gravity},
                                                                             {"g-force", gravity},
                                                                             {"mg", 1e-3 * gravity},
                                                                             {"mG", 1e-3 * gravity},
                                                                             {"milli-g", 1e-3 * gravity},
                                                                             {"ug", 1e-6 * gravity},
                                                                             {"µg", 1e-6 * gravity},
                                                                             {"Gal", 1e-2},
                                                                             {"gal", 1e-2},
                                                                             {"in/s^2", 0.0254},
                                                                             {"in/s2", 0.0254},
                                                                             {"in/s²", 0.0254},
                                                                             {"ft/s^2", 0.3048},
                                                                             {"ft/s2", 0.3048},
                                                                             {"ft/s²", 0.3048}}};

/// Units that a header may end with after an underscore; others are rather letters of a name.
constexpr std::array<std::string_view, 22> suffixes{"s",  "ms",  "us",   "ns",   "g",    "mg", "V",  "mV",
                                                    "uV", "N",   "mN",   "kN",   "mm",   "um", "Pa", "kPa",
                                                    "Hz", "ms2", "mps2", "mm_s", "m_s2", "ug"};

std::string_view bare(std::string_view text) {
    text = trimmed(text);
    constexpr std::array<std::pair<char, char>, 3> brackets{{{'(', ')'}, {'[', ']'}, {'{', '}'}}};
    for (const auto& [open, close] : brackets)
        if (text.size() >= 2 && text.front() == open && text.back() == close)
            return trimmed(text.substr(1, text.size() - 2));
    return text;
}

/// The unit in brackets at the end, and what stands before.
std::optional<std::pair<std::string_view, std::string_view>> split_bracket(std::string_view header) {
    constexpr std::array<std::pair<char, char>, 3> brackets{{{'(', ')'}, {'[', ']'}, {'{', '}'}}};
    for (const auto& [open, close] : brackets) {
        if (header.empty() || header.back() != close) continue;
        // Of nested brackets the outer: "a (m/(s*s))".
        int depth = 0;
        for (std::size_t i = header.size(); i-- > 0;) {
            depth += header[i] == close ? 1 : header[i] == open ? -1 : 0;
            if (depth == 0)
                return std::pair(trimmed(header.substr(0, i)), trimmed(header.substr(i + 1, header.size() - i - 2)));
        }
    }
    return std::nullopt;
}

}  // namespace

bool ColumnUnit::is_acceleration() const { return dimension == parse_unit("m/s^2").dimension; }
bool ColumnUnit::is_voltage() const { return dimension == parse_unit("V").dimension; }
bool ColumnUnit::is_time() const { return dimension == parse_unit("s").dimension; }

std::optional<ColumnUnit> parse_column_unit(std::string_view text) {
    text = bare(text);
    if (text.empty() || text.size() > 32 || text == "1" || text == "%") return std::nullopt;
    ColumnUnit unit{std::string(text), 1.0, {}};
    for (const auto& [spelling, factor] : accelerations)
        if (text == spelling) {
            unit.si = factor;
            unit.dimension = parse_unit("m/s^2").dimension;
            return unit;
        }
    std::string_view known = text;
    const std::string word = lower(text);
    // A header in capitals: "M/S^2" divides no mega by siemens.
    const auto is_small = [](char c) { return c >= 'a' && c <= 'z'; };
    if (text.find('/') != std::string_view::npos && std::ranges::none_of(text, is_small)) known = word;
    for (const auto& [spelling, usual] : spellings)
        if (word == spelling) known = usual;
    try {
        const Unit parsed = parse_unit(known);
        // A number is no unit, and a mass is no vibration: it would be a misread g.
        if (parsed.dimension.is_bare() || parsed.dimension == parse_unit("kg").dimension) return std::nullopt;
        unit.si = parsed.factor;
        unit.dimension = parsed.dimension;
        return unit;
    } catch (const Error&) {
        return std::nullopt;
    }
}

namespace {

std::string_view last_word(std::string_view text) {
    text = trimmed(text);
    const std::size_t blank = text.rfind(' ');
    return blank == std::string_view::npos ? text : text.substr(blank + 1);
}

}  // namespace

NamedColumn parse_column_name(std::string_view header) {
    header = trimmed(header);
    if (const auto split = split_bracket(header))
        if (std::optional<ColumnUnit> unit = parse_column_unit(split->second); unit && !split->first.empty()) {
            std::string_view name = split->first;
            if (name.size() > 1 && name.ends_with('/')) name = trimmed(name.substr(0, name.size() - 1));
            return {std::string(name), std::move(unit)};
        }
    for (const std::string_view between : {" / ", " in ", ", ", "; "})
        if (const std::size_t at = header.rfind(between); at != std::string_view::npos && at > 0)
            if (std::optional<ColumnUnit> unit = parse_column_unit(header.substr(at + between.size())))
                return {std::string(trimmed(header.substr(0, at))), std::move(unit)};
    // "Velocity m/s": a blank before a unit that is a quotient.
    const std::size_t blank = header.rfind(' ');
    if (blank != std::string_view::npos && header.find('/', blank) != std::string_view::npos)
        if (std::optional<ColumnUnit> unit = parse_column_unit(header.substr(blank + 1)))
            return {std::string(trimmed(header.substr(0, blank))), std::move(unit)};
    // "t/s" and "a/(m/s²)": quantity over unit, as ISO 80000-1 writes it. "m/s" alone is a unit.
    if (const std::size_t at = header.find('/'); at != std::string_view::npos && at > 0 && !parse_column_unit(header) &&
                                                 !parse_column_unit(last_word(header.substr(0, at))))
        if (std::optional<ColumnUnit> unit = parse_column_unit(header.substr(at + 1)))
            return {std::string(trimmed(header.substr(0, at))), std::move(unit)};
    for (const std::string_view suffix : suffixes)
        if (header.size() > suffix.size() + 1 && header.ends_with(suffix) &&
            header[header.size() - suffix.size() - 1] == '_') {
            const std::string_view usual = suffix == "ms2" || suffix == "mps2" || suffix == "m_s2" ? "m/s^2"
                                           : suffix == "mm_s"                                      ? "mm/s"
                                                                                                   : suffix;
            return {std::string(header), parse_column_unit(usual)};
        }
    // The calls of microcontrollers that give the time.
    const std::string word = lower(header);
    if (word == "millis" || word == "micros") return {std::string(header), parse_column_unit(word)};
    return {std::string(header), std::nullopt};
}

std::optional<std::string> axis_family(std::string_view name) {
    std::string word = lower(trimmed(name));
    // A unit may follow the axis: accel_x_mV.
    if (const NamedColumn named = parse_column_name(name); named.unit && named.name == name)
        if (const std::size_t at = word.rfind('_'); at != std::string::npos) word.resize(at);
    if (word.empty() || word.back() < 'x' || word.back() > 'z') return std::nullopt;
    word.pop_back();
    const auto is_blank = [](char c) { return c == '_' || c == ' ' || c == '-' || c == '.' || c == ':'; };
    if (word.empty() || is_blank(word.back())) {
        while (!word.empty() && is_blank(word.back())) word.pop_back();
        return word;
    }
    for (const std::string_view family : {"a", "acc", "accel", "acceleration", "g", "gf", "gyr", "gyro", "m", "mag",
                                          "v", "vel", "w", "b", "lin", "la", "channel", "ch"})
        if (word == family) return word;
    return std::nullopt;
}

}  // namespace tactus::table
