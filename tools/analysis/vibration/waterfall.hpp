// SPDX-License-Identifier: Apache-2.0
// Levels over order or frequency, row by row over time or speed.
#pragma once

#include "dsp/signal/order/order_spectrum.hpp"
#include "dsp/signal/spectrum/row_spectra.hpp"

#include <limits>
#include <vector>

namespace tactus::analysis {

struct WaterfallSettings {
    bool of_orders = true;      ///< columns are orders, otherwise frequencies
    bool against_speed = false;  ///< each row has one rate; otherwise one time
};

struct WaterfallRow {
    double time = 0.0;  ///< s from the start of the record to its middle; NaN for a row of one rate
    double rate = 0.0;  ///< Hz, mean
    std::vector<float> rms;  ///< per column, in the record's unit; NaN above half the sample rate
};

struct Waterfall {
    WaterfallSettings settings;
    double step = 0.0;  ///< orders or Hz between columns; the first is at 0
    std::vector<WaterfallRow> rows;  ///< by time, or by rate
};

/// Processes one channel in the order of its samples.
class WaterfallStream {
public:
    /// `stream`: of the same channel; must receive the samples first. `begin`: s, start of the record. Orders: Hann
    /// over 16 revolutions (8 for a short record), exact for multiples of a 16th order. Frequencies: flat-top windows
    /// of a quarter second, up to `highest` times the highest rate.
    WaterfallStream(const WaterfallSettings& settings, const signal::OrderStream& stream,
                    const signal::Rotation& rotation, double rate, std::size_t frames, int highest, double begin);

    void push(std::span<const double> samples, std::span<const double> turned);
    /// Throws Error if the record is too short for a row, or for rows of one rate if the rate is constant.
    Waterfall finish() const;

private:
    WaterfallSettings settings_;
    signal::Rotation rotation_;
    double rate_, first_turn_, per_turn_, begin_, step_;
    signal::RowSpectra rows_;
};

}  // namespace tactus::analysis
