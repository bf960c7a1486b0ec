// SPDX-License-Identifier: Apache-2.0
#include "devices/display/figure_painter.hpp"

#include "assets/file/module.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::display {

namespace {

constexpr int max_side = 16384;

std::string utf8(char32_t code) {
    std::string out;
    if (code < 0x80) return {static_cast<char>(code)};
    const int more = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
    constexpr unsigned heads[] = {0, 0xC0, 0xE0, 0xF0};
    out += static_cast<char>(heads[more] | (code >> (6 * more)));
    for (int n = more; n-- > 0;) out += static_cast<char>(0x80 | (code >> (6 * n) & 0x3F));
    return out;
}

}  // namespace

const FigurePainter& figure_painter() {
    using Make = const FigurePainter*();
    static const FigurePainter& loaded =
        *reinterpret_cast<Make*>(file::load_module(cairo_module, figure_painter_symbol))();
    return loaded;
}

Image Figure::image(double scale) const {
    const double wide = std::round(width_ * scale), high = std::round(height_ * scale);
    if (!(wide >= 1.0 && high >= 1.0 && wide <= max_side && high <= max_side))
        throw Error("a picture must be 1 to 16384 pixels wide and high");
    return figure_painter().image(*this, scale);
}

std::string missing_glyphs(std::span<const Figure> figures) {
    constexpr std::size_t most = 8;
    std::u32string all;
    for (const Figure& figure : figures)
        for (const Figure::Item& item : figure.items())
            if (const auto* text = std::get_if<Figure::Text>(&item))
                for (const char32_t code : figure_painter().missing(text->text))
                    if (all.find(code) == std::u32string::npos) all += code;
    if (all.empty()) return {};
    std::string list;
    for (std::size_t n = 0; n < std::min(all.size(), most); ++n)
        list += fmt::format("{}{} (U+{:04X})", n > 0 ? ", " : "", utf8(all[n]), static_cast<std::uint32_t>(all[n]));
    if (all.size() > most) list += fmt::format(" and {} more", all.size() - most);
    return fmt::format(
        "no installed font has {}: drawn as boxes; install fonts for this script, such as "
        "fonts-droid-fallback",
        list);
}

std::string pdf_of(const Figure& figure, const std::string& title) {
    constexpr double points_per_pixel = 0.75;
    return figure_painter().pdf({&figure, 1}, points_per_pixel, title);
}

}  // namespace tactus::display
