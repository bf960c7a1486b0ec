// SPDX-License-Identifier: Apache-2.0
#include "devices/display/figure.hpp"

#include "assets/table/log_lines.hpp"
#include "devices/display/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::display {

namespace {

std::string hex(const Colour& c) { return fmt::format("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue); }

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '&': out += "&amp;"; break;
            case '<': out += "&lt;"; break;
            case '>': out += "&gt;"; break;
            case '"': out += "&quot;"; break;
            default: out += c;
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

/// Path data of distinct points, in tenths of a pixel.
std::string curve_of(const std::vector<FigurePoint>& points) {
    std::string out;
    long x = 0, y = 0;
    for (const FigurePoint& p : points) {
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

constexpr double farthest = 1e5;  // units: beyond every page, and within the fixed-point numbers of Cairo

bool is_finite(const FigurePoint& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

FigurePoint bounded(const FigurePoint& p) {
    return {std::clamp(p.x, -farthest, farthest), std::clamp(p.y, -farthest, farthest)};
}

std::string plain_text(std::string text) {
    text = table::as_utf8(text);
    std::ranges::replace_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
    return text;
}

/// Characters that XML allows in an id and CSS needs no escape for.
std::string id_of(std::string_view text) {
    std::string out;
    for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '-';
    return out;
}

void add_arc(std::vector<FigurePoint>& to, FigurePoint centre, double radius, double from, double angle) {
    constexpr int pieces = 6;  // per quarter of a circle
    const int count = std::max(1, static_cast<int>(std::lround(std::abs(angle) / (0.5 * std::numbers::pi) * pieces)));
    for (int n = 0; n <= count; ++n) {
        const double at = from + angle * n / count;
        to.push_back({centre.x + radius * std::cos(at), centre.y + radius * std::sin(at)});
    }
}

/// The SVG of one list.
class SvgWriter {
public:
    explicit SvgWriter(std::string_view prefix) : prefix_(prefix) {}

    void add(const Figure::Line& line) {
        out += fmt::format(
            "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\"{}{} stroke-linejoin=\"round\"/>\n",
            line.points.size() < 500 ? path_of(line.points) : curve_of(line.points), hex(line.colour), line.width,
            opacity("stroke-opacity", line.colour),
            line.dash > 0.0 ? fmt::format(" stroke-dasharray=\"{:g}\"", line.dash) : "");
    }
    void add(const Figure::Fill& fill) {
        out += fmt::format("<path d=\"{}Z\" fill=\"{}\"{}/>\n", path_of(fill.outline), hex(fill.colour),
                           opacity("fill-opacity", fill.colour));
    }
    void add(const Figure::Text& text) {
        const char* anchors[] = {"", " text-anchor=\"middle\"", " text-anchor=\"end\""};
        out += fmt::format(
            "<text x=\"{0:.2f}\" y=\"{1:.2f}\" font-size=\"{2:g}\" fill=\"{3}\"{4}{5}{6}{7}>{8}</text>\n", text.at.x,
            text.at.y, text.size, hex(text.colour), anchors[static_cast<int>(text.anchor)],
            text.bold ? " font-weight=\"bold\"" : "",
            text.turned ? fmt::format(" transform=\"rotate(-90 {:.2f} {:.2f})\"", text.at.x, text.at.y) : "",
            text.halo ? fmt::format(" stroke=\"#ffffff\" stroke-width=\"{:.3g}\" stroke-linejoin=\"round\" "
                                    "paint-order=\"stroke\"",
                                    3.0 * text.size / 13.0)
                      : "",
            escaped(text.text));
    }
    void add(const Figure::Cells& cells) {
        image(cells, " style=\"image-rendering:pixelated\"",
              palette_png_bytes(cells.columns, cells.rows, cells.cells, cells.palette));
    }
    void add(const Figure::Picture& picture) { image(picture, "", png_bytes(picture.image)); }
    void add(const Figure::Clip& clip) {
        if (!clip.on) out += "</g>\n";
        else {
            out += fmt::format(
                "<clipPath id=\"{0}c{1}\"><rect x=\"{2:g}\" y=\"{3:g}\" width=\"{4:g}\" "
                "height=\"{5:g}\"/></clipPath>\n<g clip-path=\"url(#{0}c{1})\">\n",
                prefix_, clips_, clip.x, clip.y, clip.width, clip.height);
            ++clips_;
        }
    }
    void add(const Figure::Group& group) {
        if (!group.opens) out += "</g>\n";
        else
            out += fmt::format("<g id=\"{}{}\">{}\n", prefix_, id_of(group.id),
                               group.title.empty() ? "" : "<title>" + escaped(group.title) + "</title>");
    }

    std::string out;

private:
    template <class Item>
    void image(const Item& at, const char* style, const std::string& png) {
        out += fmt::format(
            "<image x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" preserveAspectRatio=\"none\"{} "
            "href=\"data:image/png;base64,{}\"/>\n",
            at.x, at.y, at.width, at.height, style, base64(png));
    }

    std::string prefix_;
    int clips_ = 0;
};

}  // namespace

void Figure::line(std::vector<FigurePoint> points, Colour colour, double width, double dash) {
    std::vector<FigurePoint> piece;
    const auto add = [&] {
        if (piece.size() > 1) items_.emplace_back(Line{thinned(piece), colour, width, dash});
        piece.clear();
    };
    for (const FigurePoint& p : points)
        if (is_finite(p)) piece.push_back(bounded(p));
        else add();
    add();
}

void Figure::curve(FigurePoint from, FigurePoint control, FigurePoint other_control, FigurePoint to, Colour colour,
                   double width, double dash) {
    constexpr int pieces = 24;
    std::vector<FigurePoint> points;
    for (int n = 0; n <= pieces; ++n) {
        const double t = static_cast<double>(n) / pieces, s = 1.0 - t;
        const std::array<double, 4> weight{s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t};
        points.push_back({weight[0] * from.x + weight[1] * control.x + weight[2] * other_control.x + weight[3] * to.x,
                          weight[0] * from.y + weight[1] * control.y + weight[2] * other_control.y + weight[3] * to.y});
    }
    line(std::move(points), colour, width, dash);
}

void Figure::fill(std::vector<FigurePoint> outline, Colour colour) {
    std::erase_if(outline, [](const FigurePoint& p) { return !is_finite(p); });
    for (FigurePoint& p : outline) p = bounded(p);
    if (outline.size() > 2) items_.emplace_back(Fill{std::move(outline), colour});
}

void Figure::rectangle(double x, double y, double width, double height, Colour colour) {
    fill({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}, colour);
}

void Figure::rounded(double x, double y, double width, double height, double radius, Colour colour, Colour rim,
                     double rim_width) {
    constexpr double quarter = 0.5 * std::numbers::pi;
    std::vector<FigurePoint> outline;
    add_arc(outline, {x + width - radius, y + radius}, radius, -quarter, quarter);
    add_arc(outline, {x + width - radius, y + height - radius}, radius, 0.0, quarter);
    add_arc(outline, {x + radius, y + height - radius}, radius, quarter, quarter);
    add_arc(outline, {x + radius, y + radius}, radius, 2.0 * quarter, quarter);
    fill(outline, colour);
    if (!(rim_width > 0.0)) return;
    outline.push_back(outline.front());
    line(std::move(outline), rim, rim_width);
}

void Figure::disc(FigurePoint centre, double radius, Colour colour) {
    std::vector<FigurePoint> outline;
    add_arc(outline, centre, radius, 0.0, 2.0 * std::numbers::pi);
    outline.pop_back();
    fill(std::move(outline), colour);
}

void Figure::cells(double x, double y, double width, double height, int columns, int rows,
                   std::vector<std::uint8_t> cells, std::vector<Colour> palette) {
    items_.emplace_back(Cells{x, y, width, height, columns, rows, std::move(cells), std::move(palette)});
}

void Figure::picture(double x, double y, double width, double height, Image image) {
    if (!image.rgb.empty()) items_.emplace_back(Picture{x, y, width, height, std::move(image)});
}

void Figure::text(FigurePoint at, std::string text, double size, Colour colour, TextAnchor anchor, bool bold,
                  bool turned, bool halo) {
    if (!is_finite(at) || text.empty()) return;
    items_.emplace_back(Text{bounded(at), plain_text(std::move(text)), size, colour, anchor, bold, turned, halo});
}

void Figure::clip(double x, double y, double width, double height) {
    unclip();
    items_.emplace_back(Clip{x, y, width, height, true});
    is_clipped_ = true;
}

void Figure::unclip() {
    if (is_clipped_) items_.emplace_back(Clip{0.0, 0.0, 0.0, 0.0, false});
    is_clipped_ = false;
}

void Figure::begin(std::string id, std::string title) {
    unclip();
    items_.emplace_back(Group{std::move(id), plain_text(std::move(title)), true});
}

void Figure::end() {
    unclip();
    items_.emplace_back(Group{"", "", false});
}

void Figure::place(const Figure& other, double x, double y, double scale) {
    const auto moved = [&](FigurePoint& p) { p = {x + scale * p.x, y + scale * p.y}; };
    const auto resize = [&](auto& box) {
        box.x = x + scale * box.x, box.y = y + scale * box.y, box.width *= scale, box.height *= scale;
    };
    unclip();
    for (Item item : other.items_) {
        if (auto* line = std::get_if<Line>(&item)) {
            std::ranges::for_each(line->points, moved);
            line->width *= scale, line->dash *= scale;
        } else if (auto* fill = std::get_if<Fill>(&item)) {
            std::ranges::for_each(fill->outline, moved);
        } else if (auto* text = std::get_if<Text>(&item)) {
            moved(text->at);
            text->size *= scale;
        } else if (auto* clip = std::get_if<Clip>(&item)) {
            resize(*clip);
            is_clipped_ = clip->on;
        } else if (auto* cells = std::get_if<Cells>(&item)) {
            resize(*cells);
        } else if (auto* picture = std::get_if<Picture>(&item)) {
            resize(*picture);
        }
        items_.push_back(std::move(item));
    }
    unclip();
}

std::string Figure::svg(std::string_view prefix) const {
    SvgWriter to(prefix);
    to.out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} {1:g}\" "
        "font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n<rect width=\"100%\" height=\"100%\" "
        "fill=\"#ffffff\"/>\n",
        width_, height_);
    for (const Item& item : items_) std::visit([&](const auto& one) { to.add(one); }, item);
    return to.out + (is_clipped_ ? "</g>\n" : "") + "</svg>\n";
}

}  // namespace tactus::display
