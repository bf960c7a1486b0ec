// SPDX-License-Identifier: Apache-2.0
// The spectral analysis of records as a result.
#pragma once

#include "tools/report/figures/spectrum_figure.hpp"
#include "tools/report/vibration/record_fields.hpp"

#include <string>
#include <vector>

namespace tactus::report {

/// The settings of an analysis as text.
struct SpectrumMethod {
    std::string window = "hann", detrend = "constant", average = "mean", scaling = "density";
    std::string envelope, fundamental;  ///< LOW:HIGH in Hz; empty: no envelope
    double overlap = 0.5;               ///< fraction of a segment
    bool cepstrum = false;              ///< its peaks are printed
    PlottedBand band;
};

/// Of a record. It does not refer to `file`; without `keeps_figure` it has no figure.
Result spectrum_result(const analysis::AnalysedFile& file, const SpectrumMethod& method, bool keeps_figure);
/// Of a record that could not be read.
Result unread_spectrum(const std::string& file, const std::string& error);
/// Rows of `spectrum_columns`, one per channel.
std::vector<file::Json> spectrum_rows(const analysis::AnalysedFile& file, const SpectrumMethod& method);
extern const std::vector<std::string> spectrum_columns;

/// The records in order.
struct Spectra {
    std::vector<Result> records;
    const SpectrumMethod* method;
};

const Fields<Spectra>& spectrum_fields();

}  // namespace tactus::report
