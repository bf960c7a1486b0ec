// SPDX-License-Identifier: Apache-2.0
// A plot area with two axes, linear or logarithmic, in a figure.
#pragma once

#include "devices/display/figure.hpp"
#include "tools/report/figures/figure_style.hpp"

#include <array>
#include <string>
#include <vector>

namespace tactus::report {

/// Blue, vermilion, green and purple of Okabe and Ito (2008), distinct with every kind of colour blindness.
inline constexpr std::array<display::Colour, 4> curve_colours{
    {{0x00, 0x72, 0xB2}, {0xD5, 0x5E, 0x00}, {0x00, 0x9E, 0x73}, {0xCC, 0x79, 0xA7}}};
inline constexpr display::Colour axis_ink{0x22, 0x26, 0x2E}, axis_soft{0x6B, 0x72, 0x80};

struct Scale {
    double low, high;
    bool is_log;
    double step = 0.0;  ///< between the ticks of a linear scale; 0: about five ticks; infinite: no ticks

    double share(double v) const;  ///< 0 at `low`, 1 at `high`; a little beyond both at most
    std::vector<double> ticks() const;
};

struct Axes {
    display::Figure& figure;
    double x, y, width, height;  ///< the inner rectangle, in units of the figure
    Scale across, up;
    const FigureStyle& style = screen_style;

    display::FigurePoint at(double a, double b) const;
    /// Grid, ticks, numbers, title and units.
    void draw(const std::string& title, const std::string& unit_across, const std::string& unit_up) const;
    void curve(const std::vector<display::FigurePoint>& values, display::Colour colour, double dash, bool dots) const;
    /// A dashed horizontal line, with a word above its end or, `below`, below its begin.
    void level(double value, display::Colour colour, const std::string& word, bool below = false) const;
};

}  // namespace tactus::report
