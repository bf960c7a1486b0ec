// SPDX-License-Identifier: Apache-2.0
// Order tracking: a spectrum over revolutions instead of time, in which each order of a varying speed is one line.
#pragma once

#include "dsp/signal/order/rotation.hpp"
#include "dsp/signal/spectrum/welch.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tactus::signal {

struct OrderLevel {
    double order = 0.0;
    double amplitude = 0.0;  ///< peak, in the record's unit
    double snr_db = 0.0;  ///< over the median between the orders
    bool above_nyquist = false;  ///< at the highest rate it is above half the sample rate: no level
};

struct OrderSpectrum {
    std::vector<double> amplitude;  ///< peak; value i is at order i · step
    double step = 0.0;  ///< orders
    std::size_t segments = 0;
    double turns = 0.0;  ///< number of revolutions used
    double end = 0.0;    ///< order at half the sample rate, at the highest rate; nothing above is measured
    std::vector<OrderLevel> orders;  ///< 1, 2, … highest
};

/// Orders of a record that comes in pieces, in constant memory: resampled at even angles over its whole turns,
/// low-passed for the new spacing, flat up to 1 / 1.02 of `highest`. Flat-top windows over whole numbers of turns (32; at
/// least 8 for a short record).
class OrderStream {
public:
    /// `frames`: samples of the record at `rate` Hz. Throws Error when the record has fewer than 8 turns.
    OrderStream(double rate, std::size_t frames, const Rotation& rotation, int highest);

    void push(std::span<const double> samples);
    /// Call when all samples were pushed.
    OrderSpectrum spectrum();

    /// The values at even angles from the last call: `per_turn` per turn, starting at `first_turn`.
    std::span<const double> turned() const { return turned_; }
    std::size_t per_turn() const { return per_turn_; }
    std::size_t turns() const { return turns_; }
    double first_turn() const { return first_turn_; }

private:
    void produce(bool all);

    double rate_, first_turn_;
    Rotation rotation_;
    std::size_t frames_, per_turn_, turns_, together_, count_, done_ = 0;
    int highest_;
    std::optional<WelchStream<double>> welch_;
    std::vector<double> held_, turned_;
    std::size_t held_from_ = 0;  // index of the first held sample
};

/// The same for a record in memory.
OrderSpectrum order_spectrum(std::span<const double> record, double rate, const Rotation& rotation, int highest);

/// Hz: highest rate of a rotation.
double highest_rate(const Rotation& rotation);

}  // namespace tactus::signal
