// SPDX-License-Identifier: Apache-2.0
#include "assets/table/decimal_sign.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace tactus::table {

namespace {

std::string without_commas(std::string text) {
    std::erase(text, ',');
    return text;
}

std::string with_point(std::string text) {
    std::replace(text.begin(), text.end(), ',', '.');
    return text;
}

/// One to three digits, then groups of three between commas or points.
bool may_be_grouped(std::string_view field, std::size_t first) {
    const std::size_t sign = field.front() == '+' || field.front() == '-' ? 1 : 0;
    bool grouped = first > sign && first <= sign + 3 && field[sign] != '0';
    for (std::size_t at = first; grouped && at < field.size(); at += 4)
        grouped = (field[at] == ',' || field[at] == '.') && field.size() >= at + 4 &&
                  field.substr(at + 1, 3).find_first_not_of("0123456789") == std::string_view::npos &&
                  (field.size() == at + 4 || field[at + 4] == ',' || field[at + 4] == '.');
    return grouped;
}

}  // namespace

std::optional<std::string> DecimalSign::note(std::string_view field, int line) {
    if (field.empty() || field.find_first_not_of("+-0123456789.,eE") != std::string_view::npos) return std::nullopt;
    const std::size_t comma = field.find(','), point = field.find('.');
    if (comma == std::string_view::npos && point == std::string_view::npos) return std::nullopt;
    const std::size_t first = std::min(comma, point);
    const auto refuse = [&](const char* why) {
        return fmt::format("'{}' {}; write numbers without them", field.substr(0, 40), why);
    };
    if (field.find_first_of(",.", first + 1) != std::string_view::npos) return refuse("has thousands separators");
    const bool grouped = may_be_grouped(field, first);
    if (comma != std::string_view::npos) {
        if (!grouped) commas_ = true;
        else if (grouped_.empty()) grouped_ = field, grouped_line_ = line;
    } else {
        (grouped && separator_ != ',' ? maybe_points_ : points_) = true;
    }
    return std::nullopt;
}

std::optional<DecimalSign::Doubt> DecimalSign::doubt() const {
    if (commas_ && (points_ || maybe_points_))
        return Doubt{"some numbers have a decimal comma and some a point; write all alike", 0};
    if (!grouped_.empty() && !commas_)
        return Doubt{
            fmt::format("'{}' may be {} or {}: no other number of the file shows whether the comma is decimal; "
                        "write numbers with a point",
                        grouped_, without_commas(grouped_), with_point(grouped_)),
            grouped_line_};
    return std::nullopt;
}

char DecimalSign::sign() const { return commas_ ? ',' : points_ || maybe_points_ ? '.' : '\0'; }

std::optional<double> DecimalSign::parse_known(std::string_view field) const {
    double number = 0.0;
    const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (failure != std::errc{} || end != field.data() + field.size() || !std::isfinite(number)) return std::nullopt;
    if (!points_ && field.find('.') != std::string_view::npos) return std::nullopt;
    return number;
}

std::optional<double> DecimalSign::parse(std::string_view field) const {
    std::array<char, 64> buffer;
    if (field.size() < buffer.size() && field.find(',') != std::string_view::npos) {
        std::replace_copy(field.begin(), field.end(), buffer.begin(), ',', '.');
        field = {buffer.data(), field.size()};
    }
    if (field.starts_with('+')) field.remove_prefix(1);
    double number = 0.0;
    const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), number);
    // Too small for a double is zero.
    if (failure == std::errc::result_out_of_range && end == field.data() + field.size() &&
        (field.find("e-") != std::string_view::npos || field.find("E-") != std::string_view::npos))
        return 0.0;
    if (failure != std::errc{} || end != field.data() + field.size()) return std::nullopt;
    return number;
}

}  // namespace tactus::table
