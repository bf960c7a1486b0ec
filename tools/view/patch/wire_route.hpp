// SPDX-License-Identifier: Apache-2.0
// The way of a wire in the picture of a patch: straight over where nothing stands between its ends, and otherwise through
// the gaps between boxes.
#pragma once

#include "tools/view/canvas.hpp"

#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace tactus::view {

using BezierCurve = std::array<Point, 4>;

/// Points on a curve, ends included: t from 0 to 1.
Point on_curve(const BezierCurve& curve, double t);
/// From an output to an input: leaves to the right and arrives from the left.
BezierCurve curve_between(Point from, Point to);
/// The box around its four points, in which all of it lies.
Box bounds_of(const BezierCurve& curve);

double distance_to(const BezierCurve& curve, Point at);

/// Finds ways among boxes that stand still. Those of one output run together, others beside each other.
class WireRouter {
public:
    /// `levels`: heights at which a wire may run along, beside those between boxes.
    WireRouter(std::vector<Box> boxes, std::span<const double> levels);

    /// Pieces that follow each other from an output to an input. `source`: the same number for wires of one output.
    std::vector<BezierCurve> way(Point from, Point to, int source);

private:
    bool is_hidden(const BezierCurve& curve) const;
    double cost(Point from, Point to, double level) const;
    double lane_of(std::size_t level, int source);

    std::vector<Box> boxes_;
    std::vector<double> levels_;
    std::map<std::size_t, std::vector<int>> taken_;  // by level: the outputs whose wires run there
};

}  // namespace tactus::view
