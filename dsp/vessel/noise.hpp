// SPDX-License-Identifier: Apache-2.0
// Noise of a scan near a position: its standard deviation and its correlation length.
#pragma once

#include "dsp/vessel/tube.hpp"

namespace tactus::vessel {

struct Noise {
    double sigma = 0.0;    ///< standard deviation, in values of the scan
    Vec3 correlation{1.0};  ///< per axis: number of samples that form one independent sample

    Sampling sampling(const Scan& scan) const {
        return {scan.voxel_volume() * correlation.x * correlation.y * correlation.z};
    }
};

/// Estimates the noise from differences of samples one and four apart, in a box of 49 samples per side around `centre`,
/// using only samples between `low` and `high`. Medians reduce the effect of edges; texture of tissue counts as noise.
/// Assumes a normal correlation.
Noise measured_noise(const Scan& scan, const Vec3& centre, double low, double high);

}  // namespace tactus::vessel
