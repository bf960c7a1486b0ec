// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/figure_file.hpp"

#include "assets/file/whole_file.hpp"
#include "devices/display/figure_painter.hpp"
#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"

namespace tactus::report {

std::string write_figure(const display::Figure& figure, const std::filesystem::path& path, double dpi) {
    constexpr double units_per_inch = 96.0;
    const std::filesystem::path ending = path.extension();
    if (ending == ".svg") {
        // Whoever shows the file chooses the fonts.
        file::write_whole_file(path, figure.svg());
        return {};
    }
    if (ending == ".png") file::write_whole_file(path, display::png_bytes(figure.image(dpi / units_per_inch), dpi));
    else if (ending == ".pdf") file::write_whole_file(path, display::pdf_of(figure, path.stem().string()));
    else throw Error(path.string() + ": a figure is written as .svg, .png or .pdf");
    return display::missing_glyphs({&figure, 1});
}

bool is_figure_file(const std::filesystem::path& path) {
    const std::filesystem::path ending = path.extension();
    return ending == ".svg" || ending == ".png" || ending == ".pdf";
}

}  // namespace tactus::report
