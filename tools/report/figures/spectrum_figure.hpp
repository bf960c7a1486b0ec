// SPDX-License-Identifier: Apache-2.0
// Figures of spectra: of one record by channel, or of several records in one plot.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/analysis/vibration/spectrum_analysis.hpp"

#include <optional>
#include <span>
#include <utility>

namespace tactus::report {

/// Hz: the plotted band; none: 20 Hz (less for a slow record) to half the sample rate.
using PlottedBand = std::optional<std::pair<double, double>>;

/// Per channel (at most four): the spectrum with named lines, marks and the limit of touch; below it the spectrogram and
/// the spectrum of the envelope if available. Throws Error when the record has nothing in the band.
display::Figure draw_spectrum(const analysis::AnalysedFile& file, const PlottedBand& band = {});

/// The curves that one figure can hold, told apart by colour and dashes.
inline constexpr std::size_t max_curves = 14;

/// All channels of all records in one plot with one axis of levels, and their envelopes in a second one if available.
/// Throws Error for more than `max_curves`, for records in different units, or with nothing in the band.
display::Figure draw_overlay(std::span<const analysis::AnalysedFile> files, const PlottedBand& band = {});

/// Resolves the default. Throws Error when `rate` has nothing in the band.
std::pair<double, double> plotted_range(const PlottedBand& band, double rate);

/// "dB re (1 µm/s²)²/Hz", or without "/Hz" for a spectrum of powers.
std::string level_unit(const analysis::AnalysedFile& file);

}  // namespace tactus::report
