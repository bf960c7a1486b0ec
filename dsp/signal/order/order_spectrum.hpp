// SPDX-License-Identifier: Apache-2.0
// A record over the angle of a machine instead of over time: a run-up stands still, each order is one line.
#pragma once

#include "dsp/signal/order/rotation.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// `record` (samples per second `rate`) at evenly spaced angles, `per_turn` values per revolution, over the whole turns
/// that lie inside the record. Low-passed on the way to what `per_turn` can carry: flat up to 0.39 · per_turn orders. Allocates.
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
    double turns = 0.0;  ///< revolutions that were used
    std::vector<OrderLevel> orders;  ///< 1, 2, … highest
};

/// Flat-top windows over whole numbers of turns (32, fewer for a short record; at least 8). Throws Error when the record
/// holds fewer than 8 turns.
OrderSpectrum order_spectrum(std::span<const double> record, double rate, const Rotation& rotation, int highest);

}  // namespace tactus::signal
