// SPDX-License-Identifier: Apache-2.0
// A measured elastic object: deflection over force, for loading and unloading.
#pragma once

#include <string>
#include <vector>

namespace tactus::control {

/// Deflection over force, with hysteresis: while the force rises the object follows `loading`, while it falls
/// `unloading`, and between the two curves it rests (a play operator; Olsson 2012, Publication VI of the thesis,
/// renders measured tables). Piecewise linear; the outermost pieces continue beyond its ends.
struct DeflectionTable {
    std::vector<double> force;  ///< N, rising
    std::vector<double> loading;  ///< m at each force, non-decreasing
    std::vector<double> unloading;  ///< m, nowhere below `loading`; equal: no hysteresis

    /// New deflection under force `f` of an object at `deflection`. Real-time safe.
    double follow(double deflection, double f) const noexcept;
    /// Lowest stiffness of the table, N/m.
    double min_stiffness() const;
    /// Message that says what is wrong; empty when the table is valid.
    std::string fault() const;
};

}  // namespace tactus::control
