// SPDX-License-Identifier: Apache-2.0
// The unit of a column of times that are numbers: from the name of the column, or from the times themselves.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct TimeUnit {
    std::string symbol;  ///< "s", "ms", "us" or "ns"
    double seconds = 1.0;  ///< of one unit
};

/// "s", "ms", "us" and "ns".
std::span<const TimeUnit> time_units();
/// A word for a unit of time, such as "ms", "millis", "Microseconds", "nanos"; none for other words.
std::optional<TimeUnit> time_unit_of_word(std::string_view word);
/// The unit that a part of a name states: "TimeUS", "t_ms", "timestamp (ns)", "Unix time in milliseconds", "timems".
std::optional<TimeUnit> time_unit_in_name(std::string_view name);
/// True if a part of the name is a word for time: "Elapsed Time", "TimeUS", "sensor_timestamp", "Zeit", "t".
bool is_time_name(std::string_view name);

/// Mean step of times in their unit: equal times count as steps of 0, and gaps (longer than five median steps) are left
/// out. 0 if the times do not advance.
double mean_step(std::span<const double> times);

struct TimeUnitGuess {
    std::vector<TimeUnit> fitting;  ///< one: the unit; several: not decidable; none: implausible in any unit
    bool is_epoch = false;  ///< decided by the size of the first time, which is a date from 2001 to 2096
};

/// The units in which samples with that mean step come at 10 Hz to 200 kHz (with a margin of a tenth, so that a rate at
/// an end is never excluded by rounding). A first time that is a date of 2001 to 2096 in one of them decides. Vibration
/// is recorded at these rates; a unit that is wrong by 1000 turns a verdict around, so two units that fit are reported
/// rather than weighed against each other.
TimeUnitGuess guess_time_unit(double first_time, double step);

/// The unit of times that neither state nor name one: that of a date, that of a rate which the file states, or the only plausible
/// one, with the reason.
struct SettledTimeUnit {
    TimeUnit unit;
    std::string reason;
};
/// `times`: the first of them, without `origin`. `rate`: Hz, as stated; 0: none. `rate_place`: where, "line 3". `fail` is called
/// with the message when no unit or several fit, and must throw.
SettledTimeUnit settle_time_unit(std::span<const double> times, double origin, double rate,
                                 const std::string& rate_place, const std::string& column,
                                 const std::function<void(const std::string&)>& fail);

}  // namespace tactus::table
