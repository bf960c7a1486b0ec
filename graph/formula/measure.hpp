// SPDX-License-Identifier: Apache-2.0
// What kind of quantity a value is: exponents of base units, fractions of them too.
#pragma once

#include "dsp/core/units.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace tactus::formula {

/// Exponents of the base units of `Dimension`, in twelfths: a force per length^1.5 has a kind of its own.
struct Measure {
    static constexpr int whole = 12;
    std::array<int, Dimension::base_count> twelfths{};

    bool operator==(const Measure&) const = default;
    bool is_bare() const { return *this == Measure{}; }
    /// "N/m", "m^1.5"; "a number" for a bare one.
    std::string text() const;
};

Measure measure_of(const Dimension& dimension);
/// Of a product (sign 1) or a quotient (sign −1). Throws Error when an exponent leaves ±100.
Measure combined(const Measure& a, const Measure& b, int sign);
/// Of a power. Nothing when an exponent is no twelfth or leaves ±100.
std::optional<Measure> raised(const Measure& measure, double exponent);

/// SI value of one unit, and its kind.
struct MeasuredUnit {
    double factor = 1.0;
    Measure measure;
};

/// A unit whose exponents may be fractions: "N/m^1.5". Throws Error naming what is unknown.
MeasuredUnit parse_measured_unit(std::string_view text);

}  // namespace tactus::formula
