// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/number_list.hpp"
#include "graph/node/node.hpp"
#include "nodes/math/componentwise.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tactus::nodes {

struct Curve {
    static constexpr auto about =
        "Maps a number, or each sample of a signal, by a curve of straight lines through given points. Before the "
        "first "
        "and after the last point the curve is level. SI units.";
    static constexpr bool shapes_values = true;

    AnyIn in{"the value", kinds::number | kinds::signal};
    AnyOut out{"the value of the curve"};
    Text points{"0 0, 1 1", "input and output of each point, by rising input: \"0 0, 0.5 0.1, 1 1\""};

    void prepare(const Setup& setup) {
        points_.clear();
        for (const std::vector<double>& point : rows_of_numbers(points.value, points.where)) {
            if (point.size() != 2) setup.fail("a point of a curve has an input and an output, as in \"0 0, 1 1\"");
            if (!points_.empty() && point[0] <= points_.back().x)
                setup.fail("the inputs of a curve's points must rise");
            points_.push_back({point[0], point[1]});
        }
        if (points_.empty()) setup.fail("a curve needs a point, as in \"0 0, 1 1\"");
    }

    std::vector<PortSlope> slopes() const {
        double steepest = 0.0;
        std::vector<double> before;
        for (const std::vector<double>& point : rows_of_numbers(points.value, points.where)) {
            if (before.size() == 2 && point.size() == 2)
                steepest = std::max(steepest, std::abs((point[1] - before[1]) / (point[0] - before[0])));
            before = point;
        }
        return {{"in", steepest}};
    }

    void process(const Tick& tick) noexcept {
        for_each_component(in, out, tick, [this](double x) { return at(x); });
    }

private:
    struct Point {
        double x, y;
    };

    double at(double x) const noexcept {
        // NaN counts as below the first point.
        if (!(x > points_.front().x)) return points_.front().y;
        if (x >= points_.back().x) return points_.back().y;
        const auto right = std::ranges::upper_bound(points_, x, {}, &Point::x);
        const Point &b = *right, &a = *(right - 1);
        return a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
    }

    std::vector<Point> points_;
};

TACTUS_NODE(Curve, in, out, points)

}  // namespace tactus::nodes
