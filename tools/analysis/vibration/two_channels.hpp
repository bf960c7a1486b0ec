// SPDX-License-Identifier: Apache-2.0
// Frequency response and coherence between two channels of a record.
#pragma once

#include "dsp/signal/spectrum/cross.hpp"
#include "tools/analysis/vibration/record.hpp"

#include <complex>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tactus::analysis {

enum class Estimator { h1, h2, hv };

struct ResponseSettings {
    RecordSettings record;  ///< its channels: input and output
    Estimator estimator = Estimator::h1;
    signal::WindowKind window = signal::WindowKind::hann;
    std::optional<std::size_t> segment;  ///< samples; none: about 0.75 s
    double overlap = 0.5;                ///< fraction of a segment
};

/// A Hann window lowers a resonance of this half-power width (bins) by about 0.1 dB, and a narrower one by more.
inline constexpr double min_peak_bins = 10.0;

struct ResponsePeak {
    double hz = 0.0, level_db = 0.0, phase = 0.0, coherence = 0.0;  ///< phase in rad
    double deviation_db = 0.0;  ///< standard deviation of the level, by noise
    /// Width at half power; twice that of the other side where a neighbour follows before half power; 0: unknown.
    double bins = 0.0;
    bool is_smeared = false;  ///< narrower than min_peak_bins, or the coherence dips: the level may be too low
};

struct TwoChannels {
    std::string input, output;  ///< names of the channels
    double rate = 0.0, duration = 0.0;  ///< Hz, s
    double usable = 0.0;  ///< Hz: upper limit of the reliable frequency range
    sound::Calibration calibration;
    std::optional<sound::LogFacts> log;
    sound::ReadStretch stretch;
    Estimator estimator = Estimator::h1;
    signal::WelchSettings welch;
    signal::CrossSpectra spectra;
    std::vector<std::complex<double>> h1, h2, hv;  ///< output per input, per bin
    std::vector<double> coherence, deviation;  ///< per bin; the second: standard deviation of |H1|, relative
    double noise_coherence = 0.0;  ///< mean coherence of unrelated noise with the same number of segments
    /// s, of the output: mean slope of the phase where the coherence is above 0.9, of a dead time and of the resonances
    /// together; 0: unknown.
    double delay = 0.0;
    /// Of the chosen estimate, the highest 5: where the coherence is at least 0.8, or dips from at least 0.8 beside it,
    /// as it does over a resonance that the segments do not resolve.
    std::vector<ResponsePeak> peaks;

    const std::vector<std::complex<double>>& chosen() const;
};

/// Throws Error, also for other than two channels or fewer than 4 segments.
TwoChannels analyse_two_channels(const std::filesystem::path& file, const ResponseSettings& settings,
                                 const std::function<void(double)>& progress);

}  // namespace tactus::analysis
