// SPDX-License-Identifier: Apache-2.0
// Follows a vessel from one seed: templates of a tube, several hypotheses a step (Friman, Hindennach, Kühnel and Peitgen,
// Medical Image Analysis 14, 2010).
#pragma once

#include "dsp/vessel/track.hpp"

namespace tactus::vessel {

struct TrackSettings {
    double least_radius = 0.4e-3, most_radius = 20e-3;  ///< m
    double axial_window = 2.25;  ///< radii (Friman)
    double across_window = 2.5;  ///< radii; Friman: 4.5, which holds the neighbours, too
    double step = 1.0;  ///< radii
    int fan = 3;  ///< (2 · fan + 1)² directions a step
    double most_angle = 1.05;  ///< rad, of a step to the next
    int depth = 3;  ///< steps that are looked ahead
    double psf_voxels = 0.6;  ///< standard deviation of the scanner's point spread, in samples
    double least_contrast = 0.4;  ///< of the running median: below it the vessel ends
    double most_length = 2.0;  ///< m
    bool branches = true;
    std::optional<double> clip_below;  ///< lower values count as this one; for HU: -150
    std::optional<double> exclude_above;  ///< value of bone or stent; none: from the vessel's own brightness
};

/// Everything reached from the seed. No branches when there is no vessel at the seed; `why` then says why.
struct Followed {
    Track track;
    std::string why;
};

/// Throws Error when the seed lies outside of the scan, or on bone or a stent. Allocates.
Followed follow(const volume::Grid& grid, const Vec3& seed, const TrackSettings& settings = {});

}  // namespace tactus::vessel
