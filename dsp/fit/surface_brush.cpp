// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/surface_brush.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::fit {

SurfaceBrush::SurfaceBrush(std::vector<contact::SurfacePoint> points)
    : points_(std::move(points)), order_(points_.size()) {
    Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const contact::SurfacePoint& p : points_) {
        low = glm::min(low, p.position);
        high = glm::max(high, p.position);
    }
    if (points_.empty()) low = high = Vec3(0.0);
    origin_ = low;
    // At most one cube per point.
    for (;; side_ *= 1.25) {
        double count = 1.0;
        for (int axis = 0; axis < 3; ++axis) count *= std::floor((high[axis] - low[axis]) / side_) + 1.0;
        if (count <= static_cast<double>(points_.size()) + 64.0) break;
    }
    for (int axis = 0; axis < 3; ++axis)
        size_[static_cast<std::size_t>(axis)] = static_cast<int>((high[axis] - low[axis]) / side_) + 1;
    cubes_.resize(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                  static_cast<std::size_t>(size_[2]));
    for (const contact::SurfacePoint& p : points_) ++cubes_[index_of(cell_of(p.position))].end;
    std::uint32_t at = 0;
    for (Cube& cube : cubes_) {
        cube.first = at;
        at += cube.end;
        cube.end = cube.first;
    }
    for (std::size_t n = 0; n < points_.size(); ++n) {
        order_[cubes_[index_of(cell_of(points_[n].position))].end++] = static_cast<std::uint32_t>(n);
        if (points_[n].label == contact::surface_label::none || points_[n].label == contact::surface_label::as_scanned)
            continue;
        ++labelled_;
        area_ += points_[n].area;
    }
}

SurfaceBrush::Cell SurfaceBrush::cell_of(const Vec3& p) const noexcept {
    Cell c{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        // Positions outside are clamped to the outermost cubes.
        c[a] = static_cast<int>(std::clamp((p[axis] - origin_[axis]) / side_, 0.0, static_cast<double>(size_[a] - 1)));
    }
    return c;
}

std::size_t SurfaceBrush::index_of(const Cell& c) const noexcept {
    return static_cast<std::size_t>(c[0]) +
           static_cast<std::size_t>(size_[0]) *
               (static_cast<std::size_t>(c[1]) + static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(c[2]));
}

template <class Visit>
void SurfaceBrush::cubes(const Cell& low, const Cell& high, const Visit& visit) const noexcept {
    for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j)
            for (std::size_t i = index_of({low[0], j, k}), end = index_of({high[0], j, k}); i <= end; ++i) visit(i);
}

void SurfaceBrush::stroke(const Vec3& middle, double radius, std::uint8_t label) noexcept {
    if (points_.empty()) return;
    cubes(cell_of(middle - Vec3(radius)), cell_of(middle + Vec3(radius)), [&](std::size_t i) {
        Cube& cube = cubes_[i];
        if (cube.first == cube.end || (cube.label == label && cube.uniform == cube.end - cube.first)) return;
        std::uint32_t same = 0;
        for (std::uint32_t n = cube.first; n < cube.end; ++n) {
            contact::SurfacePoint& p = points_[order_[n]];
            const Vec3 difference = p.position - middle;
            if (p.label != label && p.label != contact::surface_label::as_scanned &&
                glm::dot(difference, difference) <= radius * radius) {
                const bool was = p.label != contact::surface_label::none, is = label != contact::surface_label::none;
                p.label = label;
                if (was != is) {
                    labelled_ += is ? std::size_t{1} : ~std::size_t{0};
                    area_ += is ? p.area : -p.area;
                }
            }
            same += p.label == label;
        }
        cube.label = label;
        cube.uniform = same;
    });
}

double SurfaceBrush::distance(const Vec3& place) const noexcept {
    double least = farthest * farthest;
    // Expands the search until nothing beyond can be nearer.
    for (double reach = side_; !points_.empty(); reach = std::min(2.0 * reach, farthest)) {
        cubes(cell_of(place - Vec3(reach)), cell_of(place + Vec3(reach)), [&](std::size_t i) {
            for (std::uint32_t n = cubes_[i].first; n < cubes_[i].end; ++n) {
                const Vec3 difference = points_[order_[n]].position - place;
                least = std::min(least, glm::dot(difference, difference));
            }
        });
        if (least <= reach * reach || reach >= farthest) break;
    }
    return std::sqrt(least);
}

}  // namespace tactus::fit
