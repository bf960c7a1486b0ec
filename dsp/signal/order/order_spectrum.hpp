// SPDX-License-Identifier: Apache-2.0
// Order tracking: a spectrum over revolutions instead of time, in which each order of a varying speed is one line.
#pragma once

#include "dsp/signal/order/rotation.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// `record` (samples per second `rate`) resampled at `per_turn` evenly spaced angles per revolution, over the whole
/// turns in the record. Low-passed for `per_turn`: flat up to 0.39 · per_turn orders. Allocates.
std::vector<double> resample_over_angle(std::span<const double> record, double rate, const Rotation& rotation,
                                        std::size_t per_turn);

struct OrderLevel {
    double order = 0.0;
    double amplitude = 0.0;  ///< peak, in the record's unit
    double snr_db = 0.0;  ///< over the median between the orders
};

struct OrderSpectrum {
    std::vector<double> amplitude;  ///< peak; value i is at order i · step
    double step = 0.0;  ///< orders
    std::size_t segments = 0;
    double turns = 0.0;  ///< number of revolutions used
    std::vector<OrderLevel> orders;  ///< 1, 2, … highest
};

/// Flat-top windows over whole numbers of turns (32; at least 8 for a short record). Throws Error when the record has
/// fewer than 8 turns.
OrderSpectrum order_spectrum(std::span<const double> record, double rate, const Rotation& rotation, int highest);

}  // namespace tactus::signal
