// SPDX-License-Identifier: Apache-2.0
// What was found in records, for a page.
#pragma once

#include "tools/study/vibration/spectrum_analysis.hpp"

#include <string>

namespace tactus::picture {

/// How it was asked for, as the page says it.
struct SpectrumMethod {
    std::string window, detrend, average, scaling;
    std::string envelope, fundamental;  ///< LOW:HIGH in Hz; empty: no envelope
    double overlap = 0.5;               ///< share of a segment
};

/// Figure and tables of one file, HTML.
std::string analysis_section(const study::AnalysedFile& file, const SpectrumMethod& method);
/// How it was computed, HTML.
std::string analysis_method(const SpectrumMethod& method);

}  // namespace tactus::picture
