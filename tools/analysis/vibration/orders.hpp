// SPDX-License-Identifier: Apache-2.0
// Order analysis of a machine with a changing rate.
#pragma once

#include "dsp/signal/order/order_spectrum.hpp"
#include "tools/analysis/vibration/record.hpp"
#include "tools/analysis/vibration/waterfall.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// Source of the rate: a tachometer, otherwise a fixed rate, otherwise the strongest ridge of the spectrogram.
struct OrdersSettings {
    RecordSettings record;
    int tacho = 0;                                ///< channel from 1; 0: none
    double pulses = 1.0;                          ///< tachometer pulses per revolution
    std::optional<double> fixed;                  ///< Hz
    /// Hz, search range of a tracked rate; none: around the fundamental of the record if that is certain.
    std::optional<std::pair<double, double>> range;
    static constexpr std::pair<double, double> usual_range{20.0, 400.0};
    int highest = 10;                             ///< order
    std::optional<WaterfallSettings> waterfall;
};

struct RateRange {
    double low = 0.0, high = 0.0, mean = 0.0;  ///< Hz
};

struct OrdersOfChannel {
    std::string name;
    signal::OrderSpectrum spectrum;
    std::optional<Waterfall> waterfall;
};

struct Orders {
    double sample_rate = 0.0, duration = 0.0;  ///< Hz, s
    sound::Calibration calibration;
    sound::ReadStretch stretch;
    std::optional<sound::LogFacts> log;
    std::string source;                        ///< "tachometer", "fixed" or "ridge"
    double prominence_db = 0.0;                ///< prominence of the ridge
    RateRange rate;
    int highest = 10;  ///< order
    std::vector<OrdersOfChannel> channels;
};

/// Analyses a record of any length without gaps. Throws Error.
Orders analyse_orders(const std::filesystem::path& file, const OrdersSettings& settings);

}  // namespace tactus::analysis
