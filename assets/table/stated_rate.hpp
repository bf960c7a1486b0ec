// SPDX-License-Identifier: Apache-2.0
// The sample rate that a line above the rows of a log states.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tactus::table {

struct StatedRate {
    double rate = 0.0;   ///< Hz
    std::string doubt;   ///< why the line cannot be used; empty: it can
    std::string
        point;  ///< the number as written, if its point would group thousands in a file with decimal commas; else empty
};

/// Reads "# sample rate: 3.2 kHz", "Sampling rate (kHz): 3.2", "Sampling frequency,1000,Hz", "# Sample interval: 39.1 µs",
/// "Delta_X 0.0005 0.0005". `separator` separates the fields of the table. None if the line states no rate.
std::optional<StatedRate> stated_rate(std::string_view line, char separator);

/// The number of a header cell, with a decimal point or comma; none for other text and for thousands separators.
std::optional<double> header_number(std::string_view text);

}  // namespace tactus::table
