// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/faces.hpp"

#include "dsp/contact/neighbours.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tactus::fit {

namespace {

/// The painted points and their indices among all points.
struct Paint {
    std::vector<contact::SurfacePoint> points;
    std::vector<std::size_t> index;
    std::vector<Vec3> normal;     ///< averaged
    std::vector<double> flatness;  ///< length of the average: 1 where all normals agree
};

Paint paint_of(std::span<const contact::SurfacePoint> points, const FaceOptions& options) {
    Paint paint;
    for (std::size_t n = 0; n < points.size(); ++n)
        if (points[n].label == options.paint) {
            paint.points.push_back(points[n]);
            paint.index.push_back(n);
        }
    const contact::Neighbours neighbours(paint.points, options.smooth);
    for (std::size_t n = 0; n < paint.points.size(); ++n) {
        Vec3 sum(0.0);
        double area = 0.0;
        neighbours.around(n, [&](std::size_t m) {
            sum += paint.points[m].area * paint.points[m].normal;
            area += paint.points[m].area;
        });
        const double length = glm::length(sum);
        paint.normal.push_back(length > 0.0 ? sum / length : paint.points[n].normal);
        paint.flatness.push_back(area > 0.0 ? length / area : 0.0);
    }
    return paint;
}

constexpr int none = -1;

/// Region growing: faces start at the flattest points.
std::vector<int> grow(const Paint& paint, const contact::Neighbours& touching, const FaceOptions& options, int& count) {
    std::vector<std::size_t> order(paint.points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t n) { return paint.flatness[n]; });
    std::vector<int> face(paint.points.size(), none);
    const double least = std::cos(options.bend);
    for (const std::size_t seed : order) {
        if (face[seed] != none) continue;
        std::vector<std::size_t> queue{seed};
        Vec3 mean = paint.normal[seed] * paint.points[seed].area;
        face[seed] = count;
        for (std::size_t q = 0; q < queue.size(); ++q)
            touching.around(queue[q], [&](std::size_t m) {
                if (face[m] != none || !(glm::dot(paint.normal[m], glm::normalize(mean)) > least)) return;
                face[m] = count;
                mean += paint.normal[m] * paint.points[m].area;
                queue.push_back(m);
            });
        ++count;
    }
    return face;
}

}  // namespace

std::vector<std::vector<std::size_t>> split_faces(std::span<const contact::SurfacePoint> points,
                                                  const FaceOptions& options) {
    const Paint paint = paint_of(points, options);
    const contact::Neighbours touching(paint.points, options.max_gap);
    int count = 0;
    std::vector<int> face = grow(paint, touching, options, count);
    std::vector<double> area(static_cast<std::size_t>(count), 0.0);
    for (std::size_t n = 0; n < face.size(); ++n) area[static_cast<std::size_t>(face[n])] += paint.points[n].area;
    const auto is_small = [&](int f) { return area[static_cast<std::size_t>(f)] < options.min_area; };
    // Small pieces along edges between faces are absorbed from their borders inwards.
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t n = 0; n < face.size(); ++n) {
            if (!is_small(face[n])) continue;
            int best = none;
            double looks = -2.0;
            touching.around(n, [&](std::size_t m) {
                const double same = glm::dot(paint.normal[n], paint.normal[m]);
                if (!is_small(face[m]) && same > looks) looks = same, best = face[m];
            });
            if (best == none) continue;
            face[n] = best;
            changed = true;
        }
    }
    std::vector<std::vector<std::size_t>> faces(static_cast<std::size_t>(count));
    for (std::size_t n = 0; n < face.size(); ++n)
        if (!is_small(face[n])) faces[static_cast<std::size_t>(face[n])].push_back(paint.index[n]);
    std::erase_if(faces, [](const auto& one) { return one.empty(); });
    std::ranges::stable_sort(faces, std::ranges::greater{}, [](const auto& one) { return one.size(); });
    return faces;
}

}  // namespace tactus::fit
