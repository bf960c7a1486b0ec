// SPDX-License-Identifier: Apache-2.0
// One file's analysis, as the verb `spectrum` reports it.
#pragma once

#include "dsp/spectrum/vibration_analysis.hpp"
#include "tools/verbs.hpp"

#include <functional>

namespace tactus {

struct AnalysedChannel {
    std::string name;
    VibrationReport report;
    std::vector<std::string> warnings;
};

struct AnalysedFile {
    std::filesystem::path file;
    double rate = 0.0, duration = 0.0;  ///< Hz, s
    Calibration calibration;
    std::optional<LogFacts> log;
    WelchSettings psd;
    std::vector<AnalysedChannel> channels;
};

/// Reads and analyses a file; `progress` is told the share that is done. Throws Error.
AnalysedFile analyse_file(const std::filesystem::path& file, const SpectrumChoice& choice,
                          const std::function<void(double)>& progress);

/// 10 log10, not below −300 dB.
double decibels(double power);
/// How far a band's level scatters, dB: its bins are averaged over too.
double band_deviation(const Band& band, const Spectrum& spectrum);

std::string analysis_json(const AnalysedFile& file, const SpectrumChoice& choice);
std::string analysis_text(const AnalysedFile& file);
/// Frequency and density per channel, CSV.
std::string analysis_csv(const AnalysedFile& file);

}  // namespace tactus
