// SPDX-License-Identifier: Apache-2.0
// Removal of bone by a reciprocating saw.
#pragma once

#include "dsp/carve/carve_with.hpp"
#include "dsp/volume/bricks.hpp"

#include <array>
#include <span>

namespace tactus::carve {

/// Cuts the bone along the path of the blade at any call rate (thesis 6.2.2: removal rate inversely proportional to
/// density).
///
/// In bone every point of the tooth edge advances at most at the removal speed v = speed · (F/F_ref)^p ·
/// (rate/rate_ref) · density_ref/density; in air it follows the blade immediately. The swept edge, widened to the kerf
/// with a round front, is subtracted by d ← max(d, R − distance). Path steps are at most 1 ms and the distance to the
/// swept body is exact, so the cut depends neither on the call rate nor on the positions of the samples, and d remains
/// the exact distance to the kerf: no re-distancing is needed. Down to `depth` below the cut the field is a distance;
/// deeper, it keeps the old values, which have larger magnitudes.
///
/// The first sample places the edge at the blade. A blade that is repositioned (faster than 3 m/s, or taken out of the
/// bone) is followed without cutting. Costs: see tests/bench/carve.cpp.
class Carver {
public:
    /// Throws Error when a setting is not positive and finite, the stroke is shorter than the tooth pitch, or half the
    /// kerf exceeds the band in which the bone is stored.
    void prepare(const volume::BoneEditor& bone, const CarveSettings& settings);

    /// Changes speed, reference values and force exponent from the next update on; the blade's shape stays. A law
    /// without a finite speed removes nothing.
    void set_law(const CarveSettings& law) noexcept { core_.set_law(law); }

    /// Cuts along `samples`, oldest first; ignores samples that are not finite. The caller publishes the edits. When
    /// the budget of changed bricks is exhausted, the next update cuts the rest. Allocates nothing.
    CarveResult update(volume::BoneEditor& bone, std::span<const CarveSample> samples) noexcept;

    /// The same for fronts that are advanced elsewhere. Use one carver either with samples or with fronts.
    CarveResult update(volume::BoneEditor& bone, std::span<const CutFront> fronts) noexcept;

    /// Kerf over the largest voxel edge; below 3 the walls of the cut are not resolved.
    double kerf_voxels() const noexcept { return core_.settings().kerf / core_.voxel(); }
    double removed_m3() const noexcept { return removed_m3_; }  ///< since prepare
    const std::array<double, 4>& removed_by_density() const noexcept { return by_density_; }  ///< m³, since prepare
    /// Positions of the effective edge: centres of the round front, half a kerf behind the floor of the cut.
    std::span<const EdgeNode> edge() const noexcept { return core_.edge().nodes(); }

private:
    CarveResult add(volume::BoneEditor& bone, CarveResult result) noexcept;

    CarveCore core_;
    double removed_m3_ = 0.0;
    std::array<double, 4> by_density_{};
};

}  // namespace tactus::carve
