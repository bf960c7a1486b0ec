// SPDX-License-Identifier: Apache-2.0
#include "assets/table/clock_time.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace tactus::table {

namespace {

/// Takes digits from the front; −1 when there are none or too many.
int eat_number(std::string_view& text, std::size_t most) {
    std::size_t digits = 0;
    int number = 0;
    while (digits < text.size() && digits <= most && text[digits] >= '0' && text[digits] <= '9')
        number = 10 * number + (text[digits++] - '0');
    if (digits == 0 || digits > most) return -1;
    text.remove_prefix(digits);
    return number;
}

bool eat(std::string_view& text, char c) {
    if (text.empty() || text.front() != c) return false;
    text.remove_prefix(1);
    return true;
}

std::optional<std::int64_t> day_of(int year, int month, int day) {
    const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok()) return std::nullopt;
    return std::chrono::sys_days(date).time_since_epoch().count();
}

struct Date {
    std::optional<std::int64_t> day;
    std::string_view text;
};

/// 2024-05-17, 2024/05/17, 17.05.2024; 5/17/2024 and 17/5/2024 are dates of an unknown order.
std::optional<Date> eat_date(std::string_view& text) {
    const std::string_view whole = text;
    std::string_view rest = text;
    std::array<int, 3> parts{};
    char between = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (i > 0) {
            if (rest.empty() || (i == 2 && rest.front() != between)) return std::nullopt;
            between = rest.front();
            if (between != '-' && between != '/' && between != '.') return std::nullopt;
            rest.remove_prefix(1);
        }
        parts[i] = eat_number(rest, 4);
        if (parts[i] < 0) return std::nullopt;
    }
    Date date{std::nullopt, whole.substr(0, whole.size() - rest.size())};
    if (parts[0] >= 1000) {
        date.day = day_of(parts[0], parts[1], parts[2]);
        if (!date.day) return std::nullopt;
    } else if (parts[2] >= 1000) {
        if (between == '.') date.day = day_of(parts[2], parts[1], parts[0]);
        const bool possible = day_of(parts[2], parts[1], parts[0]) || day_of(parts[2], parts[0], parts[1]);
        if (between == '.' ? !date.day : !possible) return std::nullopt;
    } else {
        return std::nullopt;
    }
    text = rest;
    return date;
}

/// ".25", ",25" or ":250" as a fraction of a second; nothing is 0. False when it is none.
bool eat_fraction(std::string_view& text, double& seconds) {
    if (text.empty() || (text.front() != '.' && text.front() != ',' && text.front() != ':')) return true;
    const bool is_count = text.front() == ':';
    text.remove_prefix(1);
    double scale = 1.0, fraction = 0.0;
    std::size_t digits = 0;
    for (; !text.empty() && text.front() >= '0' && text.front() <= '9'; text.remove_prefix(1), ++digits)
        if (digits < 18) fraction = 10.0 * fraction + (text.front() - '0'), scale *= 10.0;
    // Behind a colon it is a count of milliseconds, which may lack leading zeros.
    if (digits == 0 || (is_count && digits > 3)) return false;
    seconds += fraction / (is_count ? 1000.0 : scale);
    return true;
}

/// "Z", "+02:00", "+0200", "-05": seconds to take away.
bool eat_zone(std::string_view& text, double& offset) {
    if (eat(text, 'Z') || eat(text, 'z')) return true;
    if (text.empty() || (text.front() != '+' && text.front() != '-')) return false;
    const double sign = text.front() == '+' ? 1.0 : -1.0;
    text.remove_prefix(1);
    std::string_view hours = text.substr(0, 2);
    text.remove_prefix(std::min<std::size_t>(2, text.size()));
    const int hour = hours.size() == 2 ? eat_number(hours, 2) : -1;
    eat(text, ':');
    const int minute = text.empty() ? 0 : eat_number(text, 2);
    if (hour < 0 || hour > 14 || minute < 0 || minute > 59) return false;
    offset = sign * (3600.0 * hour + 60.0 * minute);
    return true;
}

/// "AM" and "PM" of a 12-hour clock. False for an hour that it does not have.
bool eat_half(std::string_view& text, int& hour) {
    while (eat(text, ' ')) {
    }
    if (text.size() < 2 || (text[1] != 'M' && text[1] != 'm')) return true;
    const bool am = text[0] == 'A' || text[0] == 'a', pm = text[0] == 'P' || text[0] == 'p';
    if (!am && !pm) return true;
    if (hour < 1 || hour > 12) return false;
    hour = hour % 12 + (pm ? 12 : 0);
    text.remove_prefix(2);
    return true;
}

}  // namespace

bool is_date(std::string_view text) { return eat_date(text) && text.empty(); }

std::optional<ClockTime> parse_clock_time(std::string_view text) {
    ClockTime time;
    if (const std::optional<Date> date = eat_date(text)) {
        time.day = date->day;
        time.date = date->text;
        if (!eat(text, 'T') && !eat(text, ' ') && !eat(text, '_')) return std::nullopt;
        while (eat(text, ' ')) {
        }
    }
    int hour = eat_number(text, 2);
    if (hour < 0 || !eat(text, ':')) return std::nullopt;
    int minute = eat_number(text, 2), second = 0;
    if (minute < 0) return std::nullopt;
    if (eat(text, ':')) {
        second = eat_number(text, 2);
        if (second < 0) return std::nullopt;
    } else if (!text.empty() && (text.front() == '.' || text.front() == ',') && !time.day && time.date.empty()) {
        second = minute, minute = hour, hour = 0;  // a spreadsheet's MM:SS.f
        time.period = 3600.0;
    } else if (time.date.empty()) {
        return std::nullopt;  // HH:MM or MM:SS
    }
    double fraction = 0.0, zone = 0.0;
    if (!eat_fraction(text, fraction) || !eat_half(text, hour)) return std::nullopt;
    if (!text.empty()) {
        if (!eat_zone(text, zone) || !text.empty()) return std::nullopt;
        time.has_zone = true;
    }
    if (hour > 24 || minute > 59 || second > 60) return std::nullopt;
    time.seconds = 3600.0 * hour + 60.0 * minute + second + fraction - zone;
    return time;
}

}  // namespace tactus::table
