// SPDX-License-Identifier: Apache-2.0
// The angle of a machine over time: from a tachometer, a ridge in the spectrum, or a known rate.
#pragma once

#include "dsp/geometry/spline.hpp"

#include <span>

namespace tactus::signal {

/// Time (s from the first sample) as a smooth function of revolutions.
using Rotation = geometry::Spline;

/// Rising crossings of the middle between the tachometer's low and high level, with a hysteresis of a tenth of their
/// distance; `pulses` per revolution. Throws Error for fewer than four.
Rotation rotation_from_tacho(std::span<const double> tacho, double rate, double pulses);

/// A constant rate in Hz over `seconds`.
Rotation rotation_at(double frequency, double seconds);

struct RidgeSettings {
    double lowest = 20.0, highest = 400.0;  ///< Hz: range of the rate
    int orders = 5;  ///< number of orders expected to be strong together
    double frame = 0.25;  ///< s
    double most_change = 0.08;  ///< greatest relative change of the rate per quarter frame
};

struct Ridge {
    std::vector<double> time, frequency;  ///< s, Hz, one per quarter frame
    /// Mean over time of the orders' level above the rest of their frame, dB.
    double prominence_db = 0.0;

    Rotation rotation(double seconds) const;
};

/// Ridge tracking: the path of the rate with the strongest orders (dynamic programming on a logarithmic grid, then
/// refined between grid points). Throws Error when the record is shorter than two frames.
Ridge track_ridge(std::span<const double> record, double rate, const RidgeSettings& settings);

}  // namespace tactus::signal
