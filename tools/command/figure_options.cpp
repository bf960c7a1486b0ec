// SPDX-License-Identifier: Apache-2.0
#include "tools/command/figure_options.hpp"

#include "tools/terminal.hpp"

#include <fmt/format.h>

namespace tactus::command {

void add_figure_options(VerbOptions& verb, FigureChoice& choice, FigureStyles styles) {
    verb.add("--dpi", choice.dpi, "pixels per inch of a PNG figure").shows_default().range(36.0, 1200.0);
    if (styles == FigureStyles::all)
        verb.add("--style", choice.style, "of a figure file: screen, or journal: 85 mm wide, no text below 6 points")
            .shows_default()
            .one_of({"screen", "journal"});
}

void save_figure(const display::Figure& figure, const std::filesystem::path& path, const FigureChoice& choice) {
    const std::string warning = report::write_figure(figure, path, choice.dpi);
    if (!warning.empty()) say(stderr, fmt::format("warning: {}: {}\n", path.string(), warning));
}

}  // namespace tactus::command
