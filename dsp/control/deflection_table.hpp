// SPDX-License-Identifier: Apache-2.0
// A measured elastic object: how far it gives under which force, on the way in and on the way out.
#pragma once

#include <string>
#include <vector>

namespace tactus::control {

/// Deflection over force, with hysteresis: while the force rises the object follows `loading`, while it falls
/// `unloading`, and between the two curves it stands still (a play operator; Olsson 2012, Publication VI of the thesis,
/// renders measured tables). Piecewise linear, beyond its ends along the outermost pieces.
struct DeflectionTable {
    std::vector<double> force;  ///< N, rising
    std::vector<double> loading;  ///< m at each force, never falling
    std::vector<double> unloading;  ///< m, nowhere below `loading`; equal to it: no hysteresis

    /// Where an object at `deflection` goes under `f`. Real-time safe.
    double follow(double deflection, double f) const noexcept;
    /// Force per distance where the table is softest, N/m.
    double least_stiffness() const;
    /// What is wrong with it, for people; empty when it can be used.
    std::string fault() const;
};

}  // namespace tactus::control
