// SPDX-License-Identifier: Apache-2.0
// Figures as files.
#pragma once

#include "devices/display/figure.hpp"

#include <filesystem>
#include <string>

namespace tactus::report {

inline constexpr double figure_dpi = 192.0;  ///< of PNG files, where nothing else is asked for

/// Writes a figure as .svg, .png or .pdf, by the ending. `dpi`: pixels per inch of a PNG; a unit of a figure is 1/96 inch.
/// Returns a warning about characters that no font has, or nothing. Throws Error for another ending, and if the file
/// cannot be written.
std::string write_figure(const display::Figure& figure, const std::filesystem::path& path, double dpi = figure_dpi);

/// Whether `path` has one of these endings.
bool is_figure_file(const std::filesystem::path& path);

}  // namespace tactus::report
