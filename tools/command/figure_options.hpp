// SPDX-License-Identifier: Apache-2.0
// Options of figures, for each verb that draws one.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/command/options.hpp"
#include "tools/report/figures/figure_file.hpp"
#include "tools/report/figures/figure_style.hpp"

#include <filesystem>
#include <string>

namespace tactus::command {

struct FigureChoice {
    double dpi = report::figure_dpi;  ///< of PNG files
    std::string style = "screen";

    const report::FigureStyle& figure_style() const {
        return style == "journal" ? report::journal_style : report::screen_style;
    }
};

enum class FigureStyles { screen, all };

/// --dpi; of figures that are drawn in all styles also --style.
void add_figure_options(VerbOptions& verb, FigureChoice& choice, FigureStyles styles = FigureStyles::screen);

/// report::write_figure(); prints its warning on standard error.
void save_figure(const display::Figure& figure, const std::filesystem::path& path, const FigureChoice& choice);

}  // namespace tactus::command
