// SPDX-License-Identifier: Apache-2.0
// Complete analysis of one channel of a vibration record, in one pass and bounded memory.
#pragma once

#include "dsp/signal/filter/octave_band.hpp"
#include "dsp/signal/spectrum/bands.hpp"
#include "dsp/signal/spectrum/cepstrum.hpp"
#include "dsp/signal/spectrum/envelope.hpp"
#include "dsp/signal/spectrum/fundamental.hpp"
#include "dsp/signal/spectrum/level.hpp"
#include "dsp/signal/spectrum/lines.hpp"
#include "dsp/signal/spectrum/moments.hpp"
#include "dsp/signal/spectrum/spectrogram.hpp"

#include <optional>
#include <utility>

namespace tactus::signal {

struct AnalysisSettings {
    WelchSettings psd;  ///< of the displayed spectrum; its rate is the record's
    double lowest = lowest_fundamental, highest = highest_fundamental;  ///< Hz: range of the fundamental
    int orders = 10;
    std::optional<std::pair<double, double>> envelope;  ///< Hz: band of the envelope analysis
    bool spectrogram = false;
    int octave_filters = 0;  ///< filters per octave, 1 or 3; 0: none
    bool only_psd = false;   ///< `psd`, nothing else
};

struct VibrationReport {
    Level level;
    Moments moments;
    Spectrum psd;  ///< density, with the given settings
    Spectrum lines;  ///< density, Hann, mean: the source of lines and bands
    FundamentalEstimate fundamental;
    std::vector<Harmonic> harmonics;
    std::optional<double> thd;  ///< total harmonic distortion over the orders of the table
    Cepstrum cepstrum;  ///< of `lines`
    std::vector<FilteredBand> filtered;  ///< by octave filters, on request
    std::vector<SpectralLine> peaks;  ///< the strongest 20, by frequency
    std::vector<HumLine> hum;
    std::vector<Band> bands;  ///< of all samples; their sum is the mean square within them
    std::optional<Spectrum> envelope_spectrum;  ///< density, Hann, mean, of the envelope
    std::vector<SpectralLine> envelope;  ///< lines of the envelope's spectrum, the strongest 20
    std::optional<Spectrogram> spectrogram;
};

class VibrationAnalysis {
public:
    /// `frames`: length of the record. Throws Error when the settings are invalid.
    VibrationAnalysis(const AnalysisSettings& settings, std::size_t frames);

    /// Sets the level of the whole record, before the first `push`: bands and moments exclude its mean. Without it the mean
    /// is taken as 0, and the level is that of the samples pushed.
    void set_level(const Level& level) { known_level_ = level; }
    void push(std::span<const double> samples);
    /// Marks a gap: no segment spans it.
    void gap();
    VibrationReport report() const;

private:
    void surround();
    Spectrum band_spectrum() const;

    AnalysisSettings settings_;
    std::size_t frames_;
    std::optional<Level> known_level_;
    Level level_;  // of the samples pushed, without a known one
    Moments moments_;
    std::optional<WelchStream<double>> bands_;
    std::size_t in_piece_ = 0;  // samples since the start or the last gap
    std::size_t pushed_ = 0;
    std::vector<double> shifted_;
    std::optional<FundamentalStream> fundamental_;  // its spectrum is that of the lines
    std::optional<WelchStream<double>> psd_;  // when its settings are others, or alone
    std::optional<BandEnvelope> envelope_;
    std::optional<WelchStream<double>> envelope_spectrum_;
    std::optional<Spectrogram> spectrogram_;
    std::optional<OctaveBank> octaves_;
    std::vector<double> envelope_values_;
};

}  // namespace tactus::signal
