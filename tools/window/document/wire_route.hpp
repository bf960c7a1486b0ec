// SPDX-License-Identifier: Apache-2.0
// Routes wires in the picture of a patch: directly if nothing is between the ends, otherwise through gaps between
// boxes.
#pragma once

#include "tools/window/widgets/canvas.hpp"

#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace tactus::window {

using BezierCurve = std::array<Point, 4>;

/// Points on a curve, ends included: t from 0 to 1.
Point on_curve(const BezierCurve& curve, double t);
/// A curve from an output to an input: leaves to the right and arrives from the left.
BezierCurve curve_between(Point from, Point to);
/// Bounding box of the control points, which contains the curve.
Box bounds_of(const BezierCurve& curve);

double distance_to(const BezierCurve& curve, Point at);

/// Routes wires among fixed boxes. Wires of one output share a route, others run side by side.
class WireRouter {
public:
    /// `levels`: additional heights for horizontal runs.
    WireRouter(std::vector<Box> boxes, std::span<const double> levels);

    /// Consecutive pieces from an output to an input. `source`: equal for wires of one output.
    std::vector<BezierCurve> way(Point from, Point to, int source);

private:
    bool is_hidden(const BezierCurve& curve) const;
    double cost(Point from, Point to, double level) const;
    double lane_of(std::size_t level, int source);

    std::vector<Box> boxes_;
    std::vector<double> levels_;
    std::map<std::size_t, std::vector<int>> taken_;  // by level: the outputs with wires there
};

}  // namespace tactus::window
