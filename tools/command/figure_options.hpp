// SPDX-License-Identifier: Apache-2.0
// Options of figures, for each verb that draws one.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/command/options.hpp"
#include "tools/report/figures/figure_file.hpp"

#include <filesystem>

namespace tactus::command {

struct FigureChoice {
    double dpi = report::figure_dpi;  ///< of PNG files
};

void add_figure_options(VerbOptions& verb, FigureChoice& choice);

/// report::write_figure(); prints its warning on standard error.
void save_figure(const display::Figure& figure, const std::filesystem::path& path, const FigureChoice& choice);

}  // namespace tactus::command
