// SPDX-License-Identifier: Apache-2.0
#include "assets/segmentation/erase_strokes.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::segmentation {

namespace {

double distance_to(const Stroke& line, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < line.points.size(); ++n) {
        const Vec3 &a = line.points[n], &b = line.points[std::min(n + 1, line.points.size() - 1)];
        const Vec3 along = b - a;
        const double length2 = glm::dot(along, along);
        const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
        least = std::min(least, glm::length(p - (a + t * along)));
    }
    return least;
}

/// The box round all points.
struct Box {
    Vec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

    explicit Box(const Stroke& stroke) {
        for (const Vec3& p : stroke.points) low = glm::min(low, p), high = glm::max(high, p);
    }
    /// m along an axis that parts them; 0 when none does.
    double apart(const Box& other) const {
        const Vec3 gap = glm::max(other.low - high, low - other.high);
        return std::max({gap.x, gap.y, gap.z, 0.0});
    }
};

/// The same line with points at most `apart` from each other.
std::vector<Vec3> refined(const std::vector<Vec3>& points, double apart) {
    std::vector<Vec3> out{points.front()};
    for (std::size_t n = 1; n < points.size(); ++n) {
        const Vec3 from = points[n - 1], way = points[n] - from;
        const int parts = std::clamp(static_cast<int>(std::ceil(glm::length(way) / apart)), 1, 10'000);
        for (int part = 1; part < parts; ++part) out.push_back(as_filed(from + way * (double(part) / parts)));
        out.push_back(points[n]);
    }
    return out;
}

}  // namespace

Vec3 as_filed(const Vec3& position) { return glm::round(position * 1e6) / 1e3 * 1e-3; }

bool is_apart(const Vec3& last, double radius, const Vec3& point) { return glm::length(point - last) >= 0.25 * radius; }

bool erase_strokes(std::vector<SeedLabel>& labels, const Stroke& eraser) {
    bool is_any = false;
    const Box erased(eraser);
    for (SeedLabel& label : labels) {
        std::vector<Stroke> left;
        for (Stroke& stroke : label.strokes) {
            const double reach = eraser.radius + 0.5 * stroke.radius;
            // Most strokes are far away. Points between two others are rounded by up to a micrometre.
            if (Box(stroke).apart(erased) > reach + 2e-6) {
                left.push_back(std::move(stroke));
                continue;
            }
            std::vector<Vec3> points = refined(stroke.points, 0.5 * stroke.radius);
            std::vector<Stroke> parts;
            bool is_open = false, is_hit = false;
            for (const Vec3& p : points) {
                const bool is_erased = distance_to(eraser, p) < reach;
                is_hit = is_hit || is_erased;
                if (!is_erased) {
                    if (!is_open) parts.push_back({stroke.radius, {}});
                    parts.back().points.push_back(p);
                }
                is_open = !is_erased;
            }
            if (!is_hit) {
                left.push_back(std::move(stroke));
                continue;
            }
            is_any = true;
            left.insert(left.end(), parts.begin(), parts.end());
        }
        label.strokes = std::move(left);
    }
    return is_any;
}

}  // namespace tactus::segmentation
