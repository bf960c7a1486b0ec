// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/readable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus {

namespace {

/// Decimal exponent of the number as it is printed with that many digits: 999.96 with four has 3.
int printed_exponent(double value, int digits) {
    const std::string text = fmt::format("{:.{}e}", std::abs(value), digits - 1);
    return std::stoi(text.substr(text.find('e') + 1));
}

std::string without_zeros(std::string text) {
    if (text.find('.') == std::string::npos) return text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

enum class Prefixes { none, small, all };

/// Nobody writes kiloseconds.
Prefixes prefixes_of(std::string_view unit) {
    constexpr std::array<std::string_view, 5> all{"Hz", "N", "V", "A", "W"}, small{"s", "m", "m/s", "m/s^2", "m/s²"};
    if (std::ranges::find(all, unit) != all.end()) return Prefixes::all;
    return std::ranges::find(small, unit) != small.end() ? Prefixes::small : Prefixes::none;
}

}  // namespace

std::string plain(double value, int digits) {
    if (!std::isfinite(value)) return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
    if (value == 0.0) return "0";
    const int exponent = printed_exponent(value, digits);
    if (exponent >= 15 || exponent < -6) {
        const std::string text = fmt::format("{:.{}e}", value, digits - 1);
        return fmt::format("{}×10^{}", without_zeros(text.substr(0, text.find('e'))), exponent);
    }
    return without_zeros(fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent)));
}

std::string readable(double value, std::string_view unit, int digits) {
    if (unit.empty()) return plain(value, digits);
    const Prefixes taken = prefixes_of(unit);
    if (value == 0.0 || !std::isfinite(value) || taken == Prefixes::none)
        return fmt::format("{} {}", plain(value, digits), unit);
    constexpr std::array<std::string_view, 7> prefixes{"n", "µ", "m", "", "k", "M", "G"};
    const int exponent = printed_exponent(value, digits);
    const int step = std::clamp(static_cast<int>(std::floor(exponent / 3.0)), -3, taken == Prefixes::all ? 3 : 0);
    return fmt::format("{} {}{}", plain(value / std::pow(1000.0, step), digits),
                       prefixes[static_cast<std::size_t>(step + 3)], unit);
}

std::string axis_number(double value) {
    return std::abs(value) >= 1000.0 ? plain(value / 1000.0, 4) + "k" : plain(value, 4);
}

}  // namespace tactus
