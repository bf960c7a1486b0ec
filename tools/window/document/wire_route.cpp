// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/wire_route.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace {

// In units of the picture: clearance to boxes, width of turns, width of backward turns, and distance of parallel wires.
constexpr double clear = 4.0, turn = 58.0, back_turn = 44.0, apart = 4.0;
constexpr double per_box = 1e4;  // cost of passing behind a box, in units of length

/// A curve from the wire's end to a horizontal level.
BezierCurve bend(Point from, Point to, double out_of, double into) {
    return {from, Point{from.x + out_of, from.y}, Point{to.x - into, to.y}, to};
}

}  // namespace

Point on_curve(const BezierCurve& c, double t) {
    const double s = 1.0 - t;
    return c[0] * (s * s * s) + c[1] * (3.0 * s * s * t) + c[2] * (3.0 * s * t * t) + c[3] * (t * t * t);
}

BezierCurve curve_between(Point from, Point to) {
    const double reach = std::clamp(0.45 * std::abs(to.x - from.x), 34.0, 220.0);
    return {from, Point{from.x + reach, from.y}, Point{to.x - reach, to.y}, to};
}

Box bounds_of(const BezierCurve& curve) {
    Box box{1e300, 1e300, -1e300, -1e300};
    for (const Point& p : curve)
        box = {std::min(box.left, p.x), std::min(box.top, p.y), std::max(box.right, p.x), std::max(box.bottom, p.y)};
    return box;
}

double distance_to(const BezierCurve& curve, Point at) {
    constexpr int pieces = 24;
    double least = 1e300;
    Point a = curve[0];
    for (int i = 1; i <= pieces; ++i) {
        const Point b = on_curve(curve, static_cast<double>(i) / pieces), d = b - a, p = at - a;
        const double length = d.x * d.x + d.y * d.y;
        const double t = length > 0.0 ? std::clamp((p.x * d.x + p.y * d.y) / length, 0.0, 1.0) : 0.0;
        least = std::min(least, std::hypot(p.x - t * d.x, p.y - t * d.y));
        a = b;
    }
    return least;
}

WireRouter::WireRouter(std::vector<Box> boxes, std::span<const double> levels)
    : boxes_(std::move(boxes)), levels_(levels.begin(), levels.end()) {
    // Levels: below each box, in the middle of the gap to the next one.
    for (const Box& box : boxes_) {
        double below = 1e300;
        for (const Box& other : boxes_)
            if (other.left < box.right && box.left < other.right && other.top > box.bottom)
                below = std::min(below, other.top);
        if (below < 1e300) levels_.push_back(0.5 * (box.bottom + below));
    }
    std::ranges::sort(levels_);
    const auto same = std::ranges::unique(levels_, [](double a, double b) { return b - a < 2.0 * apart; });
    levels_.erase(same.begin(), same.end());
}

bool WireRouter::is_hidden(const BezierCurve& curve) const {
    constexpr int pieces = 24;
    const Box around = bounds_of(curve);
    return std::ranges::any_of(boxes_, [&](const Box& box) {
        if (!box.meets(around)) return false;
        for (int i = 1; i < pieces; ++i)
            if (box.contains(on_curve(curve, static_cast<double>(i) / pieces))) return true;
        return false;
    });
}

/// Cost of a route along that level: length, and boxes it passes behind.
double WireRouter::cost(Point from, Point to, double level) const {
    const double first = from.x < to.x ? from.x + turn : from.x, last = from.x < to.x ? to.x - turn : to.x;
    const Box along{std::min(first, last), level - clear, std::max(first, last), level + clear};
    const Box out{from.x + 1.0, std::min(from.y, level), from.x + turn, std::max(from.y, level)};
    const Box in{to.x - turn, std::min(to.y, level), to.x - 1.0, std::max(to.y, level)};
    double sum = std::abs(from.y - level) + std::abs(to.y - level);
    for (const Box& box : boxes_)
        for (const Box& part : {along, out, in})
            if (box.meets(part)) sum += per_box;
    return sum;
}

/// Offset beside wires of other outputs on this level: 0, 1, −1, 2, −2, … times the distance.
double WireRouter::lane_of(std::size_t level, int source) {
    auto& sources = taken_[level];
    auto known = std::ranges::find(sources, source);
    if (known == sources.end()) known = sources.insert(sources.end(), source);
    constexpr int most = 5;  // capacity of the smallest gap
    const int place = static_cast<int>(known - sources.begin()) % most;
    return apart * ((place + 1) / 2) * (place % 2 ? 1.0 : -1.0);
}

std::vector<BezierCurve> WireRouter::way(Point from, Point to, int source) {
    const BezierCurve direct = curve_between(from, to);
    if (levels_.empty() || !is_hidden(direct)) return {direct};
    std::size_t best = 0;
    double least = 1e300;
    for (std::size_t i = 0; i < levels_.size(); ++i)
        if (const double now = cost(from, to, levels_[i]); now < least) {
            least = now;
            best = i;
        }
    const double level = levels_[best] + lane_of(best, source);
    const bool forward = to.x - from.x > 2.0 * turn;
    if (!forward) {
        // Backward: leave to the right, run back along the level, arrive from the left.
        const Point turned{from.x, level}, back{to.x, level};
        return {{from, Point{from.x + back_turn, from.y}, Point{from.x + back_turn, level}, turned},
                {turned, turned + (back - turned) * (1.0 / 3.0), turned + (back - turned) * (2.0 / 3.0), back},
                {back, Point{to.x - back_turn, level}, Point{to.x - back_turn, to.y}, to}};
    }
    const Point first{from.x + turn, level}, last{to.x - turn, level};
    return {bend(from, first, 0.6 * turn, 0.6 * turn),
            {first, first + (last - first) * (1.0 / 3.0), first + (last - first) * (2.0 / 3.0), last},
            bend(last, to, 0.6 * turn, 0.6 * turn)};
}

}  // namespace tactus::window
