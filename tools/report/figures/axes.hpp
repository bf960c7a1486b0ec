// SPDX-License-Identifier: Apache-2.0
// A plot area with two axes, linear or logarithmic, in a figure.
#pragma once

#include "devices/display/figure.hpp"

#include <array>
#include <string>
#include <vector>

namespace tactus::report {

inline constexpr std::array<display::Colour, 4> curve_colours{
    {{0x1F, 0x4E, 0x9E}, {0xB8, 0x1D, 0x24}, {0x1B, 0x7A, 0x3D}, {0x8A, 0x5A, 0x00}}};
inline constexpr display::Colour axis_ink{0x22, 0x26, 0x2E}, axis_soft{0x6B, 0x72, 0x80};

struct Scale {
    double low, high;
    bool is_log;
    double step = 0.0;  ///< between the ticks of a linear scale; 0: about five ticks

    double share(double v) const;  ///< 0 at `low`, 1 at `high`; a little beyond both at most
    std::vector<double> ticks() const;
};

struct Axes {
    display::Figure& figure;
    double x, y, width, height;  ///< the inner rectangle, in units of the figure
    Scale across, up;

    display::FigurePoint at(double a, double b) const;
    /// Grid, ticks, numbers, title and units.
    void draw(const std::string& title, const std::string& unit_across, const std::string& unit_up) const;
    void curve(const std::vector<display::FigurePoint>& values, display::Colour colour, double dash, bool dots) const;
    /// A dashed horizontal line, with a word above its end or, `below`, below its begin.
    void level(double value, display::Colour colour, const std::string& word, bool below = false) const;
};

}  // namespace tactus::report
