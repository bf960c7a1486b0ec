// SPDX-License-Identifier: Apache-2.0
// Dates and times of day in the cells of a log.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace tactus::table {

struct ClockTime {
    std::optional<std::int64_t> day;  ///< since 1970-01-01; none: only a time of day, or a date that could be two
    double seconds = 0.0;             ///< of that day; UTC when the zone is stated
    double period = 86400.0;          ///< s, after which the clock starts again; 3600 for MM:SS.f
    std::string_view date;            ///< as written; empty: none
    bool has_zone = false;
};

/// ISO 8601 "2024-05-17T14:03:07.250Z", "2024-05-17 14:03:07,25+02:00"; "17.05.2024 14:03:07", "5/17/2024 2:03:07.250 PM";
/// a time of day "14:03:07.250", "14:03:07:250" (milliseconds), or "03:07.250" (minutes). None for other text.
std::optional<ClockTime> parse_clock_time(std::string_view text);

/// A date without a time.
bool is_date(std::string_view text);

}  // namespace tactus::table
