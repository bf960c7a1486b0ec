// SPDX-License-Identifier: Apache-2.0
// Line drawings with text, output as SVG or as pixels.
#pragma once

#include "devices/display/offscreen.hpp"

#include <cstdint>
#include <string>
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

/// A list of drawing commands. One unit is a CSS pixel.
class Figure {
public:
    Figure(double width, double height) : width_(width), height_(height) {}

    /// An open line through the points; `dash` 0 is solid.
    void line(std::vector<FigurePoint> points, Colour colour, double width, double dash = 0.0);
    void fill(std::vector<FigurePoint> outline, Colour colour);
    void rectangle(double x, double y, double width, double height, Colour colour);
    /// A raster of coloured cells, as of a spectrogram: `cells` has columns × rows indices of `palette` (at most 256
    /// colours), row by row from the top. An SVG file contains it as a PNG image.
    void cells(double x, double y, double width, double height, int columns, int rows, std::vector<std::uint8_t> cells,
               std::vector<Colour> palette);
    /// `at` is on the baseline. `turned`: rotated to read upwards.
    void text(FigurePoint at, std::string text, double size, Colour colour = {}, TextAnchor anchor = TextAnchor::start,
              bool bold = false, bool turned = false);
    /// Clips to this rectangle until `unclip`.
    void clip(double x, double y, double width, double height);
    void unclip();

    /// A complete SVG file with a white background. Of the points of a line within half a pixel, only the first,
    /// lowest, highest and last are kept.
    std::string svg() const;
    /// The same as an image with `scale` pixels per unit. Text uses a scalable system font, or a built-in bitmap font.
    /// Throws Error for more than 16384 pixels per side.
    Image image(double scale = 2.0) const;

    double width() const { return width_; }
    double height() const { return height_; }

private:
    struct Line {
        std::vector<FigurePoint> points;
        Colour colour;
        double width, dash;
    };
    struct Fill {
        std::vector<FigurePoint> outline;
        Colour colour;
    };
    struct Text {
        FigurePoint at;
        std::string text;
        double size;
        Colour colour;
        TextAnchor anchor;
        bool bold, turned;
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
    using Item = std::variant<Line, Fill, Text, Clip, Cells>;
    friend class FigureRaster;

    double width_, height_;
    std::vector<Item> items_;
};

}  // namespace tactus::display
