// SPDX-License-Identifier: Apache-2.0
// When a machine was at which angle: from a tachometer, from a ridge in the spectrum, or from a known rate.
#pragma once

#include "dsp/geometry/spline.hpp"

#include <span>

namespace tactus::signal {

/// Time (s from the first sample) as a smooth function of revolutions.
using Rotation = geometry::Spline;

/// Rising crossings of the middle between the tachometer's low and high level, with a tenth of their distance as hysteresis;
/// `pulses` per revolution. Throws Error when there are fewer than four.
Rotation rotation_from_tacho(std::span<const double> tacho, double rate, double pulses);

/// A constant rate in Hz over `seconds`.
Rotation rotation_at(double frequency, double seconds);

struct RidgeSettings {
    double lowest = 20.0, highest = 400.0;  ///< Hz: where the rate may lie
    int orders = 5;  ///< that are expected to be strong together
    double frame = 0.25;  ///< s
    double most_change = 0.08;  ///< share of the rate by which it may change from frame to quarter frame
};

struct Ridge {
    std::vector<double> time, frequency;  ///< s, Hz, one per quarter frame
    /// Mean over time of how far the orders stand out of the rest of their frame, dB.
    double prominence_db = 0.0;

    Rotation rotation(double seconds) const;
};

/// The path of the rate through the record on which the orders together are strongest (dynamic programming over a
/// logarithmic grid, then refined between grid points). Throws Error when the record is shorter than two frames.
Ridge track_ridge(std::span<const double> record, double rate, const RidgeSettings& settings);

}  // namespace tactus::signal
