// SPDX-License-Identifier: Apache-2.0
// Force of a saw tooth over its depth of cut.
#pragma once

#include <algorithm>
#include <cmath>

namespace tactus::saw {

/// Forces of one tooth in bone of the reference density. Other densities scale all forces in proportion.
///
/// The numbers are `fit_cutting_law` of the published values in published.hpp; docs/explanation/sawing.md. Below 2 µm,
/// where nothing is measured, the thrust is assumed to fall in a straight line to `rub`, at which the edge only rubs.
/// The force does not depend on speed: 1.7 to 7 m/s made no difference (James 2013).
struct CuttingLaw {
    double cutting = 4.952;  ///< N along the tooth's path, from shallow on
    double thrust_shallow = 6.894;  ///< N against the tooth at the depth `shallow`
    double thrust_deep = 8.963;  ///< N at the depth `deep`; the line goes on beyond it
    double rub = 0.6894;  ///< N: below this thrust nothing is cut. Assumed: a tenth of thrust_shallow
    double shallow = 2e-6, deep = 10e-6;  ///< m
    double deepest = 20e-6;  ///< m a tooth can take at most: twice the range that was measured
    double reference_density = 1800.0;  ///< kg/m³, cortical bone
    double edge = 1e-3;  ///< m, width of the edge that was measured. Not published: the kerf of a blade is assumed

    /// The law of teeth that need that many times less force for the same depth of cut.
    CuttingLaw sharpened(double times) const noexcept {
        CuttingLaw law = *this;
        for (double* force : {&law.cutting, &law.thrust_shallow, &law.thrust_deep, &law.rub}) *force /= times;
        return law;
    }

    /// The law of an edge of another width: what counts is the force per width, for all tools.
    CuttingLaw with_edge(double width) const noexcept {
        CuttingLaw law = sharpened(edge / width);
        law.edge = width;
        return law;
    }

    /// Thrust of a tooth that takes `depth` m, N.
    double thrust(double depth) const noexcept {
        if (depth <= 0.0) return rub;
        if (depth < shallow) return rub + (thrust_shallow - rub) * depth / shallow;
        return thrust_shallow + (thrust_deep - thrust_shallow) * (depth - shallow) / (deep - shallow);
    }

    struct Depth {
        double depth;  ///< m
        double slope;  ///< m/N
    };
    /// The depth of cut that `thrust` N give.
    Depth depth(double thrust) const noexcept {
        if (!(thrust > rub)) return {0.0, 0.0};
        if (thrust < thrust_shallow) {
            const double slope = shallow / (thrust_shallow - rub);
            return {(thrust - rub) * slope, slope};
        }
        const double slope = (deep - shallow) / (thrust_deep - thrust_shallow);
        const double depth = shallow + (thrust - thrust_shallow) * slope;
        return depth < deepest ? Depth{depth, slope} : Depth{deepest, 0.0};
    }

    /// Force along the tooth's path under `thrust` N; a tooth that rubs has the same ratio as one at `shallow`.
    double along(double thrust) const noexcept { return cutting * std::min(thrust / thrust_shallow, 1.0); }
};

/// Stretch that is left of a spring after a tick in which its end advanced by `passes`·depth(force after the tick): an
/// implicit step, by Newton's method within a bracket. `force`: of a stretch in m, its value in N of the reference
/// density and its slope in N/m; 0 at 0, rising. Between 0 and `lag` whatever the numbers, so that the step cannot give
/// energy.
template <class Force>
double left_after_cut(const CuttingLaw& law, double lag, double passes, Force&& force) noexcept {
    double low = 0.0, high = lag, left = lag;
    for (int n = 0; n < 24; ++n) {
        const auto [value, rise] = force(left);
        const CuttingLaw::Depth cut = law.depth(value);
        const double miss = lag - left - passes * cut.depth;
        (miss > 0.0 ? low : high) = left;
        double next = left + miss / (1.0 + passes * cut.slope * rise);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - left) < 1e-12) return next;
        left = next;
    }
    return left;
}

/// How a row of teeth shares thrust. Teeth differ in height by more than the micrometres that they cut, so of the
/// stroke/pitch teeth that pass a place in one half-stroke only the highest cuts there: one tooth per stroke length
/// bears, and each place is cut twice per cycle.
struct ToothSharing {
    double teeth_per_m = 1.0 / 0.003;  ///< bearing at a time
    double cuts_per_cycle = 2.0;

    static ToothSharing of(double stroke, double pitch) noexcept { return {1.0 / std::max(stroke, pitch), 2.0}; }
};

}  // namespace tactus::saw
