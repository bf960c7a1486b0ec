// SPDX-License-Identifier: Apache-2.0
// Drawing lists: lines, areas, text and images, output as SVG, as pixels, as PDF.
#pragma once

#include "devices/display/offscreen.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tactus::display {

struct Colour {
    std::uint8_t red = 0, green = 0, blue = 0;
    double opacity = 1.0;
};

struct FigurePoint {
    double x = 0.0, y = 0.0;  ///< units of the figure, y downwards
};

enum class TextAnchor { start, middle, end };

/// A list of drawing commands. One unit is a CSS pixel, 1/96 inch. The list is the only thing that figures, patches, plans
/// and scopes draw into: SVG is written from it here, so that ids are ours and text stays text; PNG and PDF by Cairo and
/// Pango (figure_painter.hpp), which choose fonts, shape scripts and embed what was used.
class Figure {
public:
    struct Line {
        std::vector<FigurePoint> points;
        Colour colour;
        double width, dash;  ///< dash 0: solid
    };
    struct Fill {
        std::vector<FigurePoint> outline;
        Colour colour;
    };
    struct Text {
        FigurePoint at;  ///< on the baseline
        std::string text;  ///< UTF-8 without control characters
        double size;  ///< of the em
        Colour colour;
        TextAnchor anchor;
        bool bold, turned, halo;  ///< turned: reads upwards; halo: a white rim, over images
    };
    struct Clip {
        double x, y, width, height;
        bool on;
    };
    struct Cells {
        double x, y, width, height;
        int columns, rows;
        std::vector<std::uint8_t> cells;
        std::vector<Colour> palette;
    };
    struct Picture {
        double x, y, width, height;
        Image image;
    };
    struct Group {
        std::string id, title;
        bool opens;
    };
    using Item = std::variant<Line, Fill, Text, Clip, Cells, Picture, Group>;

    Figure(double width, double height) : width_(width), height_(height) {}

    /// An open line through the points; `dash` 0 is solid. It breaks at points that are not finite. Of the points of a long
    /// line within half a unit, only the first, lowest, highest and last are kept.
    void line(std::vector<FigurePoint> points, Colour colour, double width, double dash = 0.0);
    /// A cubic Bézier curve.
    void curve(FigurePoint from, FigurePoint control, FigurePoint other_control, FigurePoint to, Colour colour,
               double width, double dash = 0.0);
    void fill(std::vector<FigurePoint> outline, Colour colour);
    void rectangle(double x, double y, double width, double height, Colour colour);
    /// With corners of this radius and, unless its width is 0, a rim.
    void rounded(double x, double y, double width, double height, double radius, Colour colour, Colour rim = {},
                 double rim_width = 0.0);
    void disc(FigurePoint centre, double radius, Colour colour);
    /// A raster of coloured cells, as of a spectrogram: `cells` has columns × rows indices of `palette` (at most 256
    /// colours), row by row from the top. An SVG file contains it as a PNG image.
    void cells(double x, double y, double width, double height, int columns, int rows, std::vector<std::uint8_t> cells,
               std::vector<Colour> palette);
    void picture(double x, double y, double width, double height, Image image);
    /// `at` is on the baseline. `turned`: rotated to read upwards. `halo`: with a white rim. Bytes that are not UTF-8 are
    /// read as Latin-1; control characters become spaces.
    void text(FigurePoint at, std::string text, double size, Colour colour = {}, TextAnchor anchor = TextAnchor::start,
              bool bold = false, bool turned = false, bool halo = false);
    /// Clips to this rectangle until `unclip`. Clips do not nest: a second one replaces the first.
    void clip(double x, double y, double width, double height);
    void unclip();
    /// What follows until `end` has this id in SVG, and a title, which browsers show as a hint.
    void begin(std::string id, std::string title);
    void end();
    /// Appends another list at (x, y), scaled. Its ids come along.
    void place(const Figure& other, double x, double y, double scale);

    /// A complete SVG file with a white background. Every id begins with `prefix`, so that one page can hold many.
    std::string svg(std::string_view prefix = "") const;
    /// The same as an image with `scale` pixels per unit. Throws Error for more than 16384 pixels per side, and if Cairo
    /// is missing.
    Image image(double scale = 2.0) const;

    double width() const { return width_; }
    double height() const { return height_; }
    const std::vector<Item>& items() const { return items_; }

private:
    double width_, height_;
    std::vector<Item> items_;
    bool is_clipped_ = false;
};

}  // namespace tactus::display
