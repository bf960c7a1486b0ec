// SPDX-License-Identifier: Apache-2.0
#include "devices/display/figure.hpp"

#include <fmt/format.h>

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
                path_of(line->points), hex(line->colour), line->width, opacity("stroke-opacity", line->colour),
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
