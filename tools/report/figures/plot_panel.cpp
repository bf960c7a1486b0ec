// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/plot_panel.hpp"

#include "dsp/core/readable.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::report {

namespace {

constexpr display::Colour grid{0xE3, 0xE6, 0xEA}, frame{0x55, 0x5B, 0x66}, ink{0x22, 0x26, 0x2E};

}  // namespace

double PlotPanel::x_of(double hz) const {
    return x_ + width_ * std::log(hz / hz_.lowest) / std::log(hz_.highest / hz_.lowest);
}

double PlotPanel::y_of(double value) const {
    const double share = (value - value_.lowest) / (value_.highest - value_.lowest);
    return y_ + height_ * (1.0 - std::clamp(share, -0.1, 1.1));
}

void PlotPanel::axes(double value_step, const std::string& unit, bool name_frequencies) const {
    const double bottom = y_ + height_, right = x_ + width_;
    for (double decade = 10.0; decade <= hz_.highest; decade *= 10.0)
        for (int i = 1; i < 10; ++i) {
            const double hz = decade * i;
            if (hz < hz_.lowest * 0.999 || hz > hz_.highest * 1.001) continue;
            figure_.line({{x_of(hz), y_}, {x_of(hz), bottom}}, grid, 0.8);
            const bool named = i == 1 || i == 2 || i == 3 || i == 5 || (i == 4 && decade < 50.0);
            if (name_frequencies && named)
                figure_.text({x_of(hz), bottom + 14.0}, axis_number(hz), 11.0, ink, display::TextAnchor::middle);
        }
    const double first = std::ceil(value_.lowest / value_step - 1e-9) * value_step;
    for (double value = first; value <= value_.highest + 1e-9; value += value_step) {
        figure_.line({{x_, y_of(value)}, {right, y_of(value)}}, grid, 0.8);
        figure_.text({x_ - 6.0, y_of(value) + 4.0}, axis_number(std::abs(value) < 1e-9 ? 0.0 : value), 11.0, ink,
                     display::TextAnchor::end);
    }
    figure_.line({{x_, y_}, {right, y_}, {right, bottom}, {x_, bottom}, {x_, y_}}, frame, 1.0);
    figure_.text({x_ - 38.0, y_ + 0.5 * height_}, unit, 11.0, ink, display::TextAnchor::middle, false, true);
}

void PlotPanel::curve(const std::vector<double>& values, double step, display::Colour colour, double width,
                      double dash) const {
    constexpr double column = 0.5;
    std::vector<display::FigurePoint> points;
    double begin = -1e9, low = 0.0, high = 0.0;  // of the column that is being filled
    const auto end_column = [&] {
        if (points.empty() || high == low) return;
        points.back().y = high;
        points.push_back({points.back().x, low});
    };
    for (std::size_t k = 1; k < values.size(); ++k) {
        const double hz = static_cast<double>(k) * step;
        // The bins beside the range draw the curve to its edges.
        if (hz < hz_.lowest - step || hz > hz_.highest + step) continue;
        const display::FigurePoint point{x_of(hz), y_of(values[k])};
        if (point.x < begin + column) {
            low = std::min(low, point.y);
            high = std::max(high, point.y);
            continue;
        }
        end_column();
        points.push_back(point);
        begin = point.x;
        low = high = point.y;
    }
    end_column();
    figure_.clip(x_, y_, width_, height_);
    figure_.line(std::move(points), colour, width, dash);
    figure_.unclip();
}

void PlotPanel::upright(double hz, display::Colour colour, double dash) const {
    figure_.line({{x_of(hz), y_}, {x_of(hz), y_ + height_}}, colour, 1.2, dash);
}

void PlotPanel::level(double value, display::Colour colour, double dash) const {
    figure_.line({{x_, y_of(value)}, {x_ + width_, y_of(value)}}, colour, 1.2, dash);
}

}  // namespace tactus::report
