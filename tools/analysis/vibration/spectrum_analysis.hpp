// SPDX-License-Identifier: Apache-2.0
// Spectral analysis of one record.
#pragma once

#include "dsp/signal/spectrum/vibration_analysis.hpp"
#include "tools/analysis/vibration/marks.hpp"
#include "tools/analysis/vibration/record.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

struct SpectrumSettings {
    RecordSettings record;
    signal::WindowKind window = signal::WindowKind::hann;
    signal::Detrend detrend = signal::Detrend::constant;
    signal::Averaging averaging = signal::Averaging::mean;
    bool is_density = true;                            ///< unit²/Hz; otherwise unit²
    std::optional<std::size_t> segment;                ///< samples; none: about 0.75 s
    double overlap = 0.5;                              ///< fraction of a segment
    std::pair<double, double> fundamental{signal::lowest_fundamental,
                                          signal::highest_fundamental};  ///< Hz, search range
    std::optional<std::pair<double, double>> envelope;   ///< Hz, band for envelope analysis
    std::vector<Mark> marks;
    int orders = 10;
    bool spectrogram = false;
    bool only_psd = false;     ///< Welch alone, in one pass
    int octave_filters = 0;    ///< per octave, 1 or 3; 0: none
    int integrations = 0;      ///< of an acceleration: 1 velocity, 2 displacement
    double high_pass = 10.0;   ///< Hz, of each integration
};

/// Frequency limits of the velocity used to assess machines (ISO 20816-1), Hz.
inline constexpr std::pair<double, double> machine_band{10.0, 1000.0};

struct AnalysedChannel {
    std::string name;
    signal::VibrationReport report;
    /// Velocity in `machine_band`, m/s rms, whatever `integrations` is; for a calibrated acceleration whose bandwidth
    /// includes the upper limit and that has a stretch of 0.4 s without a gap. Otherwise a warning states the reason.
    std::optional<double> machine_velocity;
    /// Fraction of the record that it covers: not the ends of stretches between gaps.
    std::optional<double> machine_velocity_coverage;
    std::vector<MarkLevel> marks, envelope_marks;  ///< levels at the marks, in the spectrum and in that of the envelope
    std::vector<std::string> warnings;
};

struct AnalysedFile {
    std::filesystem::path file;
    double rate = 0.0, duration = 0.0;  ///< Hz, s
    sound::Calibration calibration;  ///< of the analysed values: after integration in m/s or m
    sound::Calibration recorded;  ///< of the record
    int integrations = 0;
    double high_pass = 0.0;  ///< Hz, of each integration
    bool only_psd = false;
    std::optional<sound::LogFacts> log;
    sound::ReadStretch stretch;
    bool is_density = true;  ///< the spectra are unit²/Hz, otherwise unit²
    std::optional<std::pair<double, double>> envelope;  ///< Hz
    std::vector<MarkPlace> marks;
    signal::WelchSettings psd;
    std::vector<AnalysedChannel> channels;
};

/// Reads and analyses a file; calls `progress` with the fraction done. Throws Error.
AnalysedFile analyse_file(const std::filesystem::path& file, const SpectrumSettings& settings,
                          const std::function<void(double)>& progress);

/// Uncertainty of a band's level, dB: the standard deviation given the averaging over its bins, and what the window
/// leaks over its borders.
double band_deviation(const signal::Band& band, const signal::Spectrum& spectrum);

}  // namespace tactus::analysis
