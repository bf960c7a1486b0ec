// SPDX-License-Identifier: Apache-2.0
// Follows a vessel from one seed: templates of a tube, several hypotheses per step (Friman, Hindennach, Kühnel and
// Peitgen, Medical Image Analysis 14, 2010).
#pragma once

#include "dsp/vessel/track.hpp"

namespace tactus::vessel {

struct TrackSettings {
    double min_radius = 0.4e-3, max_radius = 20e-3;  ///< m
    double axial_window = 2.25;  ///< radii (Friman)
    double across_window = 2.5;  ///< radii; Friman: 4.5, which would include neighbours
    double step = 1.0;  ///< radii
    int fan = 3;  ///< (2 · fan + 1)² directions per step
    double max_angle = 1.05;  ///< rad, from one step to the next
    int depth = 3;  ///< number of steps of the look-ahead
    double psf_voxels = 0.6;  ///< standard deviation of the scanner's point spread, in samples
    double min_contrast = 0.4;  ///< fraction of the running median; below it the vessel ends
    double max_length = 2.0;  ///< m
    bool branches = true;
    std::optional<double> clip_below;  ///< replaces lower values; for HU: -150
    std::optional<double> exclude_above;  ///< value of bone or stent; none: derived from the vessel's own brightness
};

/// All branches reached from the seed. If there is no vessel at the seed, there are no branches and `why` is the
/// reason.
struct Followed {
    Track track;
    std::string why;
};

/// Throws Error when the seed lies outside of the scan, or on bone or a stent. Allocates.
Followed follow(const volume::Grid& grid, const Vec3& seed, const TrackSettings& settings = {});

}  // namespace tactus::vessel
