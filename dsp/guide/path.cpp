// SPDX-License-Identifier: Apache-2.0
#include "dsp/guide/path.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::guide {

namespace {

/// Between b and c at share t, by the pyramid of Barry and Goldman with knots at √distance (centripetal).
Vec3 between(const std::array<Vec3, 4>& p, double t) {
    std::array<double, 4> knot{};
    for (std::size_t i = 1; i < 4; ++i) knot[i] = knot[i - 1] + std::sqrt(glm::distance(p[i - 1], p[i]));
    const double at = knot[1] + t * (knot[2] - knot[1]);
    std::array<Vec3, 4> level = p;
    for (std::size_t width = 1; width < 4; ++width)
        for (std::size_t i = 0; i + width < 4; ++i) {
            // The last round runs between the inner knots.
            const std::size_t low = width == 3 ? 1 : i, high = width == 3 ? 2 : i + width;
            const double share = (at - knot[low]) / (knot[high] - knot[low]);
            level[i] = level[i] + (level[i + 1] - level[i]) * share;
        }
    return level[0];
}

}  // namespace

Path::Path(std::span<const Vec3> points, bool is_smooth, bool is_closed) {
    if (points.size() < 2) throw Error("a path needs two points or more");
    if (points.size() > max_points) throw Error(fmt::format("a path has at most {} points", max_points));
    const std::size_t spans = is_closed ? points.size() : points.size() - 1;
    for (std::size_t i = 0; i < spans; ++i)
        if (!(glm::distance(points[i], points[(i + 1) % points.size()]) > 1e-9))
            throw Error("points of a path that follow each other must differ");
    const auto at = [&](std::ptrdiff_t i) {
        const auto count = static_cast<std::ptrdiff_t>(points.size());
        if (is_closed) return points[static_cast<std::size_t>((i + count) % count)];
        // Beyond its ends the path goes straight on.
        if (i < 0) return points[0] * 2.0 - points[1];
        if (i >= count) return points[points.size() - 1] * 2.0 - points[points.size() - 2];
        return points[static_cast<std::size_t>(i)];
    };
    std::vector<Vec3> line{points[0]};
    for (std::size_t i = 0; i < spans; ++i) {
        const auto n = static_cast<std::ptrdiff_t>(i);
        const int steps = is_smooth ? steps_per_span : 1;
        for (int k = 1; k < steps; ++k)
            line.push_back(between({at(n - 1), at(n), at(n + 1), at(n + 2)}, static_cast<double>(k) / steps));
        line.push_back(at(n + 1));
    }
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const double length = glm::distance(line[i], line[i + 1]);
        if (!(length > 0.0)) continue;
        pieces_.push_back({line[i], (line[i + 1] - line[i]) / length, length, length_});
        length_ += length;
    }
}

Path::Place Path::nearest(const Vec3& p) const noexcept {
    Place best;
    double least = std::numeric_limits<double>::infinity();
    for (const Piece& piece : pieces_) {
        const double along = std::clamp(glm::dot(p - piece.from, piece.direction), 0.0, piece.length);
        const Vec3 point = piece.from + piece.direction * along;
        const Vec3 away = p - point;
        const double squared = glm::dot(away, away);
        if (!(squared < least)) continue;
        least = squared;
        best = {point, piece.direction, piece.along + along};
    }
    return best;
}

std::vector<Vec3> Path::corners() const {
    std::vector<Vec3> all;
    for (const Piece& piece : pieces_) all.push_back(piece.from);
    if (!pieces_.empty()) all.push_back(pieces_.back().from + pieces_.back().length * pieces_.back().direction);
    return all;
}

}  // namespace tactus::guide
