// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/margin_wall.hpp"

#include "dsp/reconstruction/jaw_normal.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace tactus::reconstruction {

std::vector<Plane> resection_planes(const FibulaInputs& inputs) {
    std::vector<Plane> planes;
    for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
        if (inputs.resection == Resection::none || (inputs.resection == Resection::after_first && end == 1) ||
            (inputs.resection == Resection::before_last && end == 0))
            continue;
        const std::size_t n = end == 0 ? 0 : inputs.planes.size() - 1;
        planes.push_back({inputs.planes[n].origin, jaw_normal(inputs, n) * (end == 0 ? 1.0 : -1.0)});
    }
    return planes;
}

double margin_behind(const Plane& plane, std::span<const Vec3> tumour) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : tumour) least = std::min(least, glm::dot(plane.normal, p - plane.origin));
    return least;
}

std::vector<Plane> margin_walls(const FibulaInputs& inputs, std::span<const Vec3> tumour, double margin) {
    std::vector<Plane> walls;
    if (tumour.empty()) return walls;
    for (const Plane& cut : resection_planes(inputs))
        walls.push_back({cut.origin + (margin_behind(cut, tumour) - margin) * cut.normal, -cut.normal});
    return walls;
}

double OneWayWall::depth(const Vec3& place, bool is_active) noexcept {
    const double height = glm::dot(plane.normal, place - plane.origin);
    const bool has_jumped = !(glm::length(place - before_) <= radius);
    if (!(height < 0.0) || has_jumped) {
        holds_ = false;
    } else if (was_in_front_) {
        const double before = glm::dot(plane.normal, before_ - plane.origin);
        const Vec3 through = glm::mix(before_, place, before / (before - height));
        holds_ = is_active && glm::length(through - plane.origin) <= radius;
    }
    was_in_front_ = height >= 0.0;
    before_ = place;
    return holds_ ? -height : 0.0;
}

}  // namespace tactus::reconstruction
