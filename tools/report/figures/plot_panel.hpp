// SPDX-License-Identifier: Apache-2.0
// A plot area with axes in a figure.
#pragma once

#include "devices/display/figure.hpp"

#include <string>
#include <vector>

namespace tactus::report {

/// Logarithmic frequency axis and linear vertical axis.
class PlotPanel {
public:
    struct Range {
        double lowest, highest;
    };

    /// The inner rectangle, in units of the figure.
    PlotPanel(display::Figure& figure, double x, double y, double width, double height, Range hz, Range value)
        : figure_(figure), x_(x), y_(y), width_(width), height_(height), hz_(hz), value_(value) {}

    double x_of(double hz) const;
    double y_of(double value) const;  ///< clamped slightly outside the panel

    /// Draws grid, ticks and numbers; `unit` labels the axis.
    void axes(double value_step, const std::string& unit, bool name_frequencies) const;
    /// Bins that fall on one half unit across are drawn as their greatest and least value.
    void curve(const std::vector<double>& values, double step, display::Colour colour, double width,
               double dash = 0.0) const;
    void upright(double hz, display::Colour colour, double dash) const;
    void level(double value, display::Colour colour, double dash) const;

private:
    display::Figure& figure_;
    double x_, y_, width_, height_;
    Range hz_, value_;
};

}  // namespace tactus::report
