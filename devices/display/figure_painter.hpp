// SPDX-License-Identifier: Apache-2.0
// Interface of the module with Cairo and Pango, which is loaded when the first figure becomes pixels or PDF: most commands
// draw none, and loading its 30 libraries takes longer than they run.
#pragma once

#include "devices/display/figure.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::display {

/// Draws lists. Text is of DejaVu Sans; characters that it lacks come from any installed font that has them. Glyphs are
/// neither hinted nor rounded to pixels, so that widths do not depend on the resolution. All functions may run on several
/// threads at the same time.
class FigurePainter {
public:
    virtual ~FigurePainter() = default;
    virtual Image image(const Figure& figure, double scale) const = 0;
    /// A PDF file with a page for each figure, its fonts embedded, without dates: the same lists give the same file.
    virtual std::string pdf(std::span<const Figure> pages, double points_per_unit, const std::string& title) const = 0;
    /// Advance of a text, in units of `size`.
    virtual double text_width(const std::string& text, double size, bool bold) const = 0;
    /// Characters of the text that no installed font has, each once.
    virtual std::u32string missing(const std::string& text) const = 0;
    /// Closed outlines of a text, for the non-zero rule, with the origin at the start of its baseline, x to the right, y
    /// downwards, in units of `size`; sets `width` to the advance.
    virtual std::vector<std::vector<FigurePoint>> outlines(const std::string& text, double size, bool bold,
                                                           double& width) const = 0;
};

/// Loads the module at the first call. Throws Error if it cannot be loaded.
const FigurePainter& figure_painter();

/// "no font has ネ (U+30CD): install fonts for this script", or nothing if all text of the figures can be drawn.
std::string missing_glyphs(std::span<const Figure> figures);

/// One figure as a PDF file of its size. Throws Error.
std::string pdf_of(const Figure& figure, const std::string& title);

/// File name and symbol of the module. The symbol is a function that returns a `const FigurePainter*`.
inline constexpr const char *cairo_module = "tactus-cairo.so", *figure_painter_symbol = "tactus_figure_painter";

}  // namespace tactus::display
