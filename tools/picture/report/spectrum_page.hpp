// SPDX-License-Identifier: Apache-2.0
// What was found in records, for a page.
#pragma once

#include "tools/study/vibration/spectrum_analysis.hpp"

namespace tactus {

/// Figure and tables of one file, HTML.
std::string analysis_section(const AnalysedFile& file, const SpectrumChoice& choice);
/// How it was computed, HTML.
std::string analysis_method(const SpectrumChoice& choice);

}  // namespace tactus
