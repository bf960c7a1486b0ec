// SPDX-License-Identifier: Apache-2.0
// Results of spectral analysis as HTML.
#pragma once

#include "tools/report/figures/spectrum_figure.hpp"

#include <string>

namespace tactus::report {

/// The settings, as the page states them.
struct SpectrumMethod {
    std::string window, detrend, average, scaling;
    std::string envelope, fundamental;  ///< LOW:HIGH in Hz; empty: no envelope
    double overlap = 0.5;               ///< fraction of a segment
    PlottedBand band;
};

/// Figure and tables of one file, HTML.
std::string analysis_section(const analysis::AnalysedFile& file, const SpectrumMethod& method);
/// Methods, HTML.
std::string analysis_method(const SpectrumMethod& method);

}  // namespace tactus::report
