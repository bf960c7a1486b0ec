// SPDX-License-Identifier: Apache-2.0
// Noise of a scan near a place: how strong, and how far it is correlated.
#pragma once

#include "dsp/vessel/tube.hpp"

namespace tactus::vessel {

struct Noise {
    double sigma = 0.0;    ///< standard deviation, in values of the scan
    Vec3 correlation{1.0};  ///< per axis: samples that make one independent sample

    Sampling sampling(const Scan& scan) const {
        return {scan.voxel_volume() * correlation.x * correlation.y * correlation.z};
    }
};

/// From differences of samples one and four apart, in a box of 49 samples a side around `centre`, of the samples between
/// `low` and `high` alone. Medians, so that edges hardly count; texture of tissue counts as noise. A normal correlation
/// is assumed.
Noise measured_noise(const Scan& scan, const Vec3& centre, double low, double high);

}  // namespace tactus::vessel
