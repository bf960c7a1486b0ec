// SPDX-License-Identifier: Apache-2.0
// Quantities with units, as users write them: "0.8 N/mm", "1 kHz", "30 cm", "-20 deg".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace tactus {

/// Exponents of the base units. Angle and CT number count as base units so that Hz is not rad/s and HU is not a number.
struct Dimension {
    enum Base { metre, kilogram, second, ampere, radian, hounsfield, kelvin, base_count };
    std::array<std::int8_t, base_count> exponent{};

    bool operator==(const Dimension&) const = default;
    bool is_bare() const { return *this == Dimension{}; }
};

struct Quantity {
    double value = 0.0;  ///< in SI units
    Dimension dimension;
};

struct Unit {
    double factor = 1.0;  ///< SI value of one unit
    Dimension dimension;
};

/// Parses a unit: factors separated by a space, '·' or '*'; '/' divides by the next factor; '^n', '²' and '³' are
/// powers. Throws Error naming the unknown unit.
Unit parse_unit(std::string_view text);

/// "0.8 N/mm" → 800 with the dimension of N/m. A bare number is dimensionless. Throws Error.
Quantity parse_quantity(std::string_view text);

/// SI value of `text`, which must have the dimension of `like` ("N/m", "Hz"; "" for a bare number). Throws Error with
/// an example of the expected form.
double parse_as(std::string_view text, std::string_view like);

/// "800 N/m": the SI value divided by the unit's factor, in shortest form, for display.
std::string format_quantity(double si, std::string_view unit);

}  // namespace tactus
