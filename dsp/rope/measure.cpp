// SPDX-License-Identifier: Apache-2.0
#include "dsp/rope/measure.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/rope/rope.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::rope {

double length_of(std::span<const Vec3> line) noexcept {
    double sum = 0.0;
    for (std::size_t n = 0; n + 1 < line.size(); ++n) sum += glm::length(line[n + 1] - line[n]);
    return sum;
}

std::vector<Vec3> resampled(std::span<const Vec3> line, std::size_t count) {
    const double whole = length_of(line);
    if (line.size() < 2 || count < 2 || !(whole > 0.0) || !std::isfinite(whole))
        throw Error("a line needs two points apart");
    std::vector<Vec3> out;
    std::size_t at = 0;
    double passed = 0.0;
    for (std::size_t n = 0; n < count; ++n) {
        const double wanted = whole * static_cast<double>(n) / static_cast<double>(count - 1);
        double piece = glm::length(line[at + 1] - line[at]);
        while (at + 2 < line.size() && passed + piece < wanted) {
            passed += piece;
            ++at;
            piece = glm::length(line[at + 1] - line[at]);
        }
        const double part = piece > 0.0 ? std::clamp((wanted - passed) / piece, 0.0, 1.0) : 0.0;
        out.push_back(line[at] + part * (line[at + 1] - line[at]));
    }
    return out;
}

double min_bend_radius(std::span<const Vec3> line) noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 1; n + 1 < line.size(); ++n) {
        const Vec3 a = line[n] - line[n - 1], b = line[n + 1] - line[n];
        const double turn = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        if (turn > 1e-9) least = std::min(least, 0.25 * (glm::length(a) + glm::length(b)) / std::tan(0.5 * turn));
    }
    return least;
}

Vec3 transported(std::span<const Vec3> line, const Vec3& side) noexcept {
    Vec3 carried = side, before(0.0);
    for (std::size_t n = 0; n + 1 < line.size(); ++n) {
        const Vec3 d = line[n + 1] - line[n];
        const double l = glm::length(d);
        if (!(l > 0.0)) continue;
        const Vec3 now = d / l;
        if (before != Vec3(0.0)) {
            // The least rotation from `before` to `now`, by two reflections.
            const Vec3 sum = before + now;
            const double square = glm::dot(sum, sum);
            if (square > 1e-12)
                carried += -2.0 * glm::dot(carried, sum) / square * sum + 2.0 * glm::dot(carried, before) * now;
        } else {
            carried -= glm::dot(carried, now) * now;
        }
        before = now;
    }
    const double l = glm::length(carried);
    return l > 0.0 ? carried / l : carried;
}

double TwistCount::update(std::span<const Vec3> line, const Vec3& first_side, const Vec3& last_side) noexcept {
    if (line.size() < 2) return total_;
    const Vec3 end = line.back() - line[line.size() - 2];
    const double l = glm::length(end);
    if (!(l > 0.0)) return total_;
    const Vec3 axis = end / l, from = transported(line, first_side);
    const Vec3 to = last_side - glm::dot(last_side, axis) * axis;
    const double angle = std::atan2(glm::dot(glm::cross(from, to), axis), glm::dot(from, to));
    if (!is_begun_) {
        offset_ = angle;
        is_begun_ = true;
        return total_;
    }
    total_ += std::remainder(angle - offset_ - total_, 2.0 * std::numbers::pi);
    return total_;
}

ShortestPath shortest_path(std::span<const Vec3> start, const Obstacle* obstacle, double radius, std::size_t count) {
    ShortestPath path{resampled(start, std::max<std::size_t>(count, 3)), 0.0, 0.0, false};
    const double whole = length_of(path.points), segments = static_cast<double>(path.points.size() - 1);
    // A rest length that is nearly 0 makes the energy that of springs: it is least on the shortest line, and spreads
    // the points evenly.
    const double rest = std::max(0.02 * whole / segments, 2e-6), pull = 0.05;
    RopeMaterial band;
    band.stiffness = pull * rest * segments / whole;
    band.weight = 0.0;
    band.radius = radius;
    band.drag = 1e-3;
    RopeSettings settings;
    settings.substeps = 1;
    settings.max_iterations = 20;
    Rope rope(path.points, std::vector<double>(path.points.size() - 1, rest), band, settings);
    rope.hold(0, path.points.front());
    rope.hold(path.points.size() - 1, path.points.back());
    path.length = whole;
    for (int round = 0; round < 300; ++round) {
        leave_if_stopped();
        const double before = rope.length();
        rope.step(1.0, obstacle);
        path.length = rope.length();
        path.change = std::abs(path.length - before) * 10.0;
        if (round > 3 && path.change < 1e-4 * path.length) break;
    }
    path.points.assign(rope.points().begin(), rope.points().end());
    path.is_settled = path.change < 1e-3 * path.length;
    return path;
}

}  // namespace tactus::rope
