// SPDX-License-Identifier: Apache-2.0
// A reciprocating saw that cuts a bone.
#pragma once

#include "dsp/carve/carve_with.hpp"
#include "dsp/volume/bricks.hpp"

#include <array>
#include <span>

namespace tactus::carve {

/// Cuts the bone along the true path of the blade (thesis 6.2.2: removal at a rate over density), at any call rate.
///
/// Every point of the tooth edge advances in bone no faster than the removal speed v = speed · (F/F_ref)^p ·
/// (rate/rate_ref) · density_ref/density; through air it follows the blade at once. What the edge sweeps, widened to the
/// kerf with a round front, is taken out by d ← max(d, R − distance). Path steps are at most 1 ms and the distance to
/// the swept body is exact, so the cut depends neither on the call rate nor on where the samples lie, and d stays what
/// the exact distance to the same kerf is: it needs no re-distancing. Up to `depth` below the cut the field is a
/// distance; deeper, the old values stay, which are larger in amount.
///
/// The first sample puts the edge where the blade is. A blade put elsewhere (faster than 3 m/s, or taken out of the
/// bone) is followed without cutting. Costs: see tests/bench/carve.cpp.
class Carver {
public:
    /// Throws Error when a setting is not positive and finite, the stroke is shorter than the tooth pitch, or half the
    /// kerf exceeds the band outside of which the bone is not stored.
    void prepare(const volume::BoneEditor& bone, const CarveSettings& settings);

    /// Changes speed, reference values and force exponent from the next update on; the blade's shape stays. A law that
    /// gives no finite speed removes nothing.
    void set_law(const CarveSettings& law) noexcept { core_.set_law(law); }

    /// Cuts along `samples`, oldest first; samples that are not finite are ignored. The caller publishes the edits. When
    /// the bricks that may change run out, the rest is cut by the next update. Allocates nothing.
    CarveResult update(volume::BoneEditor& bone, std::span<const CarveSample> samples) noexcept;

    /// Kerf over the largest voxel edge; below 3 the walls of the cut are not resolved.
    double kerf_voxels() const noexcept { return core_.settings().kerf / core_.voxel(); }
    double removed_m3() const noexcept { return removed_m3_; }  ///< since prepare
    const std::array<double, 4>& removed_by_density() const noexcept { return by_density_; }  ///< m³, since prepare
    /// Where the saw has come to: centres of the round front, half a kerf behind the floor of the cut.
    std::span<const EdgeNode> edge() const noexcept { return core_.edge().nodes(); }

private:
    CarveCore core_;
    double removed_m3_ = 0.0;
    std::array<double, 4> by_density_{};
};

}  // namespace tactus::carve
