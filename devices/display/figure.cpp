// SPDX-License-Identifier: Apache-2.0
#include "devices/display/figure.hpp"

#include "devices/display/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::display {

namespace {

std::string hex(const Colour& c) { return fmt::format("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue); }

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&') out += "&amp;";
        else if (c == '<') out += "&lt;";
        else if (c == '>') out += "&gt;";
        else out += c;
    }
    return out;
}

std::string path_of(const std::vector<FigurePoint>& points) {
    std::string out;
    for (const FigurePoint& p : points) out += fmt::format("{}{:.2f} {:.2f}", out.empty() ? "M" : "L", p.x, p.y);
    return out;
}

/// A curve with far more points than pixels looks the same with those at the edges of its band.
std::vector<FigurePoint> thinned(const std::vector<FigurePoint>& points) {
    constexpr double step = 0.5;
    if (points.size() < 500) return points;
    std::vector<FigurePoint> out;
    for (std::size_t i = 0; i < points.size();) {
        std::size_t end = i + 1, low = i, high = i;
        while (end < points.size() && points[end].x >= points[end - 1].x && points[end].x < points[i].x + step) {
            if (points[end].y < points[low].y) low = end;
            if (points[end].y > points[high].y) high = end;
            ++end;
        }
        std::size_t kept = points.size();
        for (const std::size_t k : {i, std::min(low, high), std::max(low, high), end - 1})
            if (k != kept) out.push_back(points[kept = k]);
        i = end;
    }
    return out;
}

/// Points apart from each other, in tenths of a pixel.
std::string curve_of(const std::vector<FigurePoint>& points) {
    std::string out;
    long x = 0, y = 0;
    for (const FigurePoint& p : thinned(points)) {
        const long next_x = std::lround(10.0 * p.x), next_y = std::lround(10.0 * p.y);
        const auto tenths = [](long n) { return fmt::format("{:g}", 0.1 * static_cast<double>(n)); };
        if (out.empty()) out = fmt::format("M{} {}l", tenths(next_x), tenths(next_y));
        else out += fmt::format("{} {} ", tenths(next_x - x), tenths(next_y - y));
        x = next_x, y = next_y;
    }
    if (!out.empty() && (out.back() == ' ' || out.back() == 'l')) out.pop_back();
    return out;
}

std::string opacity(const char* name, const Colour& c) {
    return c.opacity < 1.0 ? fmt::format(" {}=\"{:.3g}\"", name, c.opacity) : "";
}

}  // namespace

void Figure::line(std::vector<FigurePoint> points, Colour colour, double width, double dash) {
    if (points.size() > 1) items_.emplace_back(Line{std::move(points), colour, width, dash});
}

void Figure::fill(std::vector<FigurePoint> outline, Colour colour) {
    if (outline.size() > 2) items_.emplace_back(Fill{std::move(outline), colour});
}

void Figure::rectangle(double x, double y, double width, double height, Colour colour) {
    fill({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}, colour);
}

void Figure::cells(double x, double y, double width, double height, int columns, int rows,
                   std::vector<std::uint8_t> cells, std::vector<Colour> palette) {
    items_.emplace_back(Cells{x, y, width, height, columns, rows, std::move(cells), std::move(palette)});
}

void Figure::text(FigurePoint at, std::string text, double size, Colour colour, TextAnchor anchor, bool bold,
                  bool turned) {
    items_.emplace_back(Text{at, std::move(text), size, colour, anchor, bold, turned});
}

void Figure::clip(double x, double y, double width, double height) {
    items_.emplace_back(Clip{x, y, width, height, true});
}

void Figure::unclip() { items_.emplace_back(Clip{0.0, 0.0, 0.0, 0.0, false}); }

std::string Figure::svg() const {
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} {1:g}\" "
        "font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n<rect width=\"100%\" height=\"100%\" "
        "fill=\"#ffffff\"/>\n",
        width_, height_);
    int clips = 0;
    for (const Item& item : items_) {
        if (const auto* line = std::get_if<Line>(&item)) {
            out += fmt::format(
                "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\"{}{} "
                "stroke-linejoin=\"round\"/>\n",
                line->points.size() < 500 ? path_of(line->points) : curve_of(line->points), hex(line->colour),
                line->width, opacity("stroke-opacity", line->colour),
                line->dash > 0.0 ? fmt::format(" stroke-dasharray=\"{:g}\"", line->dash) : "");
        } else if (const auto* fill = std::get_if<Fill>(&item)) {
            out += fmt::format("<path d=\"{}Z\" fill=\"{}\"{}/>\n", path_of(fill->outline), hex(fill->colour),
                               opacity("fill-opacity", fill->colour));
        } else if (const auto* text = std::get_if<Text>(&item)) {
            const char* anchors[] = {"start", "middle", "end"};
            out += fmt::format(
                "<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"{2:g}\" fill=\"{3}\"{4}{5}{6}>{7}</text>\n", text->at.x,
                text->at.y, text->size, hex(text->colour),
                text->anchor == TextAnchor::start
                    ? ""
                    : fmt::format(" text-anchor=\"{}\"", anchors[static_cast<int>(text->anchor)]),
                text->bold ? " font-weight=\"bold\"" : "",
                text->turned ? fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", text->at.x, text->at.y) : "",
                escaped(text->text));
        } else if (const auto* cells = std::get_if<Cells>(&item)) {
            out += fmt::format(
                "<image x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" preserveAspectRatio=\"none\" "
                "style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
                cells->x, cells->y, cells->width, cells->height,
                base64(palette_png_bytes(cells->columns, cells->rows, cells->cells, cells->palette)));
        } else if (const auto* clip = std::get_if<Clip>(&item)) {
            if (!clip->on) out += "</g>\n";
            else {
                out += fmt::format(
                    "<clipPath id=\"c{0}\"><rect x=\"{1:g}\" y=\"{2:g}\" width=\"{3:g}\" "
                    "height=\"{4:g}\"/></clipPath>\n<g clip-path=\"url(#c{0})\">\n",
                    clips, clip->x, clip->y, clip->width, clip->height);
                ++clips;
            }
        }
    }
    return out + "</svg>\n";
}

}  // namespace tactus::display
