// SPDX-License-Identifier: Apache-2.0
// Complete analysis of one channel of a vibration record, in one pass and bounded memory.
#pragma once

#include "dsp/signal/spectrum/bands.hpp"
#include "dsp/signal/spectrum/comb.hpp"
#include "dsp/signal/spectrum/envelope.hpp"
#include "dsp/signal/spectrum/level.hpp"
#include "dsp/signal/spectrum/lines.hpp"
#include "dsp/signal/spectrum/spectrogram.hpp"

#include <array>
#include <optional>
#include <utility>

namespace tactus::signal {

struct AnalysisSettings {
    WelchSettings psd;  ///< of the displayed spectrum; its rate is the record's
    double lowest = 20.0, highest = 500.0;  ///< Hz: range of the fundamental
    int orders = 10;
    std::optional<std::pair<double, double>> envelope;  ///< Hz: band of the envelope analysis
    bool spectrogram = false;
};

struct FundamentalEstimate {
    double frequency = 0.0;  ///< Hz; 0: not periodic
    double confidence = 0.0;  ///< 0 … 1
    bool steady = false;  ///< constant rate; otherwise `frequency` is the median of its path
    double low = 0.0, high = 0.0;  ///< Hz: the middle 80 % of the path, in half seconds
    std::vector<CombFit> rivals;  ///< other rates that explain the lines nearly as well
};

struct VibrationReport {
    Level level;
    Spectrum psd;  ///< density, with the given settings
    Spectrum lines;  ///< density, Hann, mean: the source of lines and bands
    FundamentalEstimate fundamental;
    std::vector<Harmonic> harmonics;
    std::vector<SpectralLine> peaks;  ///< the strongest 20, by frequency
    std::vector<HumLine> hum;
    std::vector<Band> bands;
    std::vector<SpectralLine> envelope;  ///< lines of the envelope's spectrum, the strongest 20
    std::optional<Spectrogram> spectrogram;
};

class VibrationAnalysis {
public:
    /// `frames`: length of the record. Throws Error when the settings are invalid.
    VibrationAnalysis(const AnalysisSettings& settings, std::size_t frames);

    void push(std::span<const double> samples);
    /// Marks a gap: no segment spans it.
    void gap();
    VibrationReport report() const;

private:
    void end_block();
    FundamentalEstimate fundamental(const Spectrum& lines) const;

    AnalysisSettings settings_;
    Level level_;
    WelchStream<double> lines_, block_, fresh_block_;
    std::optional<WelchStream<double>> psd_;
    std::size_t block_length_, in_block_ = 0;
    struct Second {
        double frequency, confidence;
    };
    std::vector<Second> seconds_;
    std::array<double, 8> movement_{};  // squared differences in the eighths of a block
    double last_ = 0.0;
    std::optional<BandEnvelope> envelope_;
    std::optional<WelchStream<double>> envelope_spectrum_;
    std::optional<Spectrogram> spectrogram_;
    std::vector<double> envelope_values_;
};

}  // namespace tactus::signal
