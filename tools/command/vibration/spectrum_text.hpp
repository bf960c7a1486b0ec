// SPDX-License-Identifier: Apache-2.0
// The analysis of a record as text, JSON and CSV.
#pragma once

#include "tools/analysis/vibration/spectrum_analysis.hpp"

#include <string>

namespace tactus::command {

/// The settings as text.
struct SpectrumWords {
    std::string window = "hann", detrend = "constant", average = "mean", scaling = "density";
    bool cepstrum = false;  ///< its peaks in the text
};

std::string analysis_json(const analysis::AnalysedFile& file, const SpectrumWords& words);
std::string analysis_text(const analysis::AnalysedFile& file, const SpectrumWords& words);
/// Frequency and density per channel.
std::string analysis_csv(const analysis::AnalysedFile& file);
/// Quefrency and cepstrum per channel.
std::string cepstrum_csv(const analysis::AnalysedFile& file);
/// One row per channel.
std::string analysis_rows(const analysis::AnalysedFile& file);
/// Header of these rows.
inline constexpr const char* analysis_heading =
    "file,channel,sample_rate_hz,duration_s,rms,unit,crest,fundamental_hz,confidence,hum_hz,warnings,error\n";

}  // namespace tactus::command
