// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them: without exponents, with a prefix of the unit. Files for programs hold all digits instead.
#pragma once

#include <string>
#include <string_view>

namespace tactus {

/// `digits` significant digits, never fewer than the integer part has, without trailing zeros: 12589.25 → "12589",
/// 0.000123 → "0.000123". From 1e15, and below 1e-6, as "1.2×10^-9".
std::string plain(double value, int digits = 4);

/// "12.6 kHz", "350 µs", "49 m/s^2": a value in `unit`, with the prefix by which the number lies from 1 to 1000. A unit
/// that takes no prefix ("full scale", "count", "mm/s") has a plain number; lengths and times are not made larger.
std::string readable(double value, std::string_view unit, int digits = 3);

/// The number of an axis: "500", "1k", "20k".
std::string axis_number(double value);

}  // namespace tactus
