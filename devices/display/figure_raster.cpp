// SPDX-License-Identifier: Apache-2.0
// Rasterises figures: fills every shape on a 3 × 3 finer grid and averages (supersampling).
#include "devices/display/figure.hpp"
#include "devices/display/outline_font.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::display {

namespace {

constexpr int fine = 3;

}  // namespace

class FigureRaster {
public:
    FigureRaster(const Figure& figure, double scale) : figure_(figure), scale_(scale * fine) {
        width_ = static_cast<int>(std::lround(figure.width_ * scale)) * fine;
        height_ = static_cast<int>(std::lround(figure.height_ * scale)) * fine;
        if (width_ < fine || height_ < fine || width_ > 16384 * fine || height_ > 16384 * fine)
            throw Error("a picture must be 1 to 16384 pixels wide and high");
        pixels_.assign(3 * static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 255);
        unclip();
    }

    Image draw() {
        for (const auto& item : figure_.items_) {
            if (const auto* line = std::get_if<Figure::Line>(&item)) stroke(*line);
            else if (const auto* shape = std::get_if<Figure::Fill>(&item)) fill({shape->outline}, shape->colour);
            else if (const auto* text = std::get_if<Figure::Text>(&item)) write(*text);
            else if (const auto* cells = std::get_if<Figure::Cells>(&item)) paint(*cells);
            else if (const auto* clip = std::get_if<Figure::Clip>(&item)) {
                unclip();
                if (!clip->on) continue;
                left_ = std::max(0, static_cast<int>(clip->x * scale_));
                top_ = std::max(0, static_cast<int>(clip->y * scale_));
                right_ = std::min(width_, static_cast<int>((clip->x + clip->width) * scale_));
                bottom_ = std::min(height_, static_cast<int>((clip->y + clip->height) * scale_));
            }
        }
        return averaged();
    }

private:
    using Shapes = std::vector<std::vector<FigurePoint>>;

    void unclip() { left_ = 0, top_ = 0, right_ = width_, bottom_ = height_; }

    /// Scanline fill with the non-zero winding rule.
    void fill(const Shapes& shapes, const Colour& colour) {
        struct Edge {
            double x0, y0, x1, y1;
            int turn;
        };
        std::vector<Edge> edges;
        double low = 1e9, high = -1e9;
        for (const auto& shape : shapes)
            for (std::size_t i = 0; i < shape.size(); ++i) {
                FigurePoint a = shape[i], b = shape[(i + 1) % shape.size()];
                a = {a.x * scale_, a.y * scale_};
                b = {b.x * scale_, b.y * scale_};
                if (a.y == b.y) continue;
                edges.push_back(a.y < b.y ? Edge{a.x, a.y, b.x, b.y, 1} : Edge{b.x, b.y, a.x, a.y, -1});
                low = std::min(low, edges.back().y0);
                high = std::max(high, edges.back().y1);
            }
        std::vector<std::pair<double, int>> crossings;
        const int last = std::min(bottom_ - 1, static_cast<int>(std::min(high, 1e6)));
        for (int y = std::max(top_, static_cast<int>(std::max(low, 0.0))); y <= last; ++y) {
            crossings.clear();
            const double middle = y + 0.5;
            for (const Edge& e : edges)
                if (e.y0 <= middle && middle < e.y1)
                    crossings.emplace_back(e.x0 + (e.x1 - e.x0) * (middle - e.y0) / (e.y1 - e.y0), e.turn);
            std::ranges::sort(crossings);
            int turns = 0;
            for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
                turns += crossings[i].second;
                if (turns != 0) span(y, crossings[i].first, crossings[i + 1].first, colour);
            }
        }
    }

    void span(int y, double from, double to, const Colour& colour) {
        const int first = static_cast<int>(std::ceil(std::clamp(from, -1.0, 1e6) - 0.5));
        const int end = static_cast<int>(std::ceil(std::clamp(to, -1.0, 1e6) - 0.5));
        for (int x = std::max(first, left_); x < std::min(end, right_); ++x) {
            std::uint8_t* pixel = &pixels_[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                                static_cast<std::size_t>(x))];
            const std::uint8_t ink[] = {colour.red, colour.green, colour.blue};
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + colour.opacity * (ink[c] - pixel[c])));
        }
    }

    void paint(const Figure::Cells& c) {
        const double left = c.x * scale_, top = c.y * scale_, wide = c.width * scale_, high = c.height * scale_;
        const int last = std::min(bottom_ - 1, static_cast<int>(top + high));
        for (int y = std::max(top_, static_cast<int>(top)); y <= last; ++y) {
            const int row = static_cast<int>(std::floor((y + 0.5 - top) / high * c.rows));
            if (row < 0 || row >= c.rows) continue;
            for (int column = 0; column < c.columns; ++column)
                span(y, left + wide * column / c.columns, left + wide * (column + 1) / c.columns,
                     c.palette[c.cells[static_cast<std::size_t>(row * c.columns + column)]]);
        }
    }

    /// Each segment becomes a bar with round ends; all are filled at once, so that joints are not painted twice.
    void stroke(const Figure::Line& line) {
        Shapes bars;
        double travelled = 0.0;
        for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
            const FigurePoint a = line.points[i], b = line.points[i + 1];
            const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
            if (!(length > 0.0) || !std::isfinite(length)) continue;
            if (line.dash <= 0.0) {
                bar(bars, a, b, line.width);
                continue;
            }
            for (double at = 0.0; at < length;) {
                const double phase = std::fmod(travelled + at, 2.0 * line.dash);
                const double next = std::min(length, at + (phase < line.dash ? line.dash : 2.0 * line.dash) - phase);
                if (phase < line.dash)
                    bar(bars, {a.x + dx * at / length, a.y + dy * at / length},
                        {a.x + dx * next / length, a.y + dy * next / length}, line.width);
                at = next + 1e-9;
            }
            travelled += length;
        }
        fill(bars, line.colour);
    }

    static void bar(Shapes& bars, FigurePoint a, FigurePoint b, double width) {
        const double angle = std::atan2(b.y - a.y, b.x - a.x);
        auto& shape = bars.emplace_back();
        constexpr int pieces = 6;
        for (int end = 0; end < 2; ++end)
            for (int i = 0; i <= pieces; ++i) {
                const double turn = angle + std::numbers::pi * (end + 0.5 + static_cast<double>(i) / pieces);
                const FigurePoint& centre = end == 0 ? a : b;
                shape.push_back({centre.x + 0.5 * width * std::cos(turn), centre.y + 0.5 * width * std::sin(turn)});
            }
    }

    void write(const Figure::Text& text) {
        const OutlineFont& font = text.bold ? bold_ : regular_;
        double width = 0.0;
        Shapes shapes = font.outlines(text.text, text.size, width);
        const double shift = text.anchor == TextAnchor::start    ? 0.0
                             : text.anchor == TextAnchor::middle ? -0.5 * width
                                                                 : -width;
        for (auto& shape : shapes)
            for (FigurePoint& p : shape) {
                const double x = p.x + shift, y = p.y;
                p = text.turned ? FigurePoint{text.at.x + y, text.at.y - x} : FigurePoint{text.at.x + x, text.at.y + y};
            }
        fill(shapes, text.colour);
    }

    Image averaged() const {
        Image image{width_ / fine, height_ / fine, {}};
        image.rgb.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
        std::size_t out = 0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (std::size_t c = 0; c < 3; ++c) {
                    int sum = 0;
                    for (int v = 0; v < fine; ++v)
                        for (int u = 0; u < fine; ++u)
                            sum +=
                                pixels_[3 * (static_cast<std::size_t>(fine * y + v) * static_cast<std::size_t>(width_) +
                                             static_cast<std::size_t>(fine * x + u)) +
                                        c];
                    image.rgb[out++] = static_cast<std::uint8_t>((sum + fine * fine / 2) / (fine * fine));
                }
        return image;
    }

    const Figure& figure_;
    double scale_;
    int width_ = 0, height_ = 0, left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;
    std::vector<std::uint8_t> pixels_;
    OutlineFont regular_{false}, bold_{true};
};

Image Figure::image(double scale) const { return FigureRaster(*this, scale).draw(); }

}  // namespace tactus::display
