// SPDX-License-Identifier: Apache-2.0
// Penalty energy of one pointshell point as a function of its distance to another body.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace tactus::contact {

/// Direction of the force of a point.
enum class ForceDirection : std::uint8_t {
    field_gradient,  ///< along the gradient of the interpolated distance: the exact derivative of the energy
    shell_normal,  ///< along the point's inward normal (thesis 2.4.4). Not the derivative of any energy: for comparison
};

/// Interpolation of a voxmap between its samples.
enum class Interpolation : std::uint8_t {
    trilinear,  ///< 8 samples; the gradient jumps at cell faces
    quadratic,  ///< quadratic B-spline over 27 samples; continuous gradient, shifts a surface of curvature κ by ~κh²/4
};

/// Force over penetration depth. At depth s = −distance, a point of weight w has the energy k·w·φ(s) with
///
///     φ''(s) = ramp of width 2·blend about 0, from 0 to 1; then 1; then from 1 to 0 over the second half of `saturation`,
///
/// Force and stiffness are continuous everywhere. φ is 0 farther than `blend` outside of the surface, φ' = s from the
/// depth `blend` on, and the force never exceeds k·w·saturation.
struct ContactLaw {
    double stiffness = 10e3;  ///< k: N/m per point; with by_area N/m per m² of surface
    double blend = 0.03e-3;  ///< m, half the width of the blend zone at the surface; values below 1 nm act as 1 nm
    /// m: the force levels off at stiffness × this; must exceed 2·blend. The default never saturates.
    double saturation = 1e6;
    bool by_area = false;  ///< the weight w of a point is its area (m²) instead of 1
    ForceDirection direction = ForceDirection::field_gradient;
    Interpolation interpolation = Interpolation::trilinear;
};

/// φ, dφ/ds and d²φ/ds² at depth s.
template <class Real>
struct DepthEnergy {
    Real energy, force, stiffness;
};

/// The same law in the precision of Real, with precomputed constants.
template <class Real>
struct DepthLaw {
    Real start, width, inverse_width;  // blend: from −start over width
    Real level, level_width, level_inverse;  // saturation

    explicit DepthLaw(const ContactLaw& law) noexcept {
        const double blend = std::max(law.blend, 1e-9);
        // Larger than any real depth; its square fits a float.
        const double saturation = std::min(law.saturation, 1e9);
        start = static_cast<Real>(blend);
        width = static_cast<Real>(2.0 * blend);
        inverse_width = static_cast<Real>(1.0 / (2.0 * blend));
        level = static_cast<Real>(0.5 * saturation);
        level_width = static_cast<Real>(saturation);
        level_inverse = static_cast<Real>(1.0 / saturation);
    }

    DepthEnergy<Real> operator()(Real depth) const noexcept {
        const DepthEnergy<Real> on = ramp(depth + start, width, inverse_width);
        const DepthEnergy<Real> off = ramp(depth - level, level_width, level_inverse);
        return {on.energy - off.energy, on.force - off.force, on.stiffness - off.stiffness};
    }

private:
    /// Stiffness that rises smoothly from 0 at x = 0 to 1 at x = width, and its integrals.
    static DepthEnergy<Real> ramp(Real x, Real width, Real inverse_width) noexcept {
        const Real c = std::min(std::max(x, Real(0)), width), e = std::max(x - width, Real(0));
        const Real share = c * inverse_width, half = Real(0.5) * c * share;
        return {half * c * Real(1.0 / 3.0) + e * (Real(0.5) * (width + e)), half + e, share};
    }
};

}  // namespace tactus::contact
