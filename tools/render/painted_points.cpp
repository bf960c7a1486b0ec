// SPDX-License-Identifier: Apache-2.0
#include "tools/render/painted_points.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tactus::render {

namespace {

constexpr double painted_within = 0.9e-3;  // m from a painted point

}  // namespace

void PaintedPoints::add(const Vec3& point, const Vec3& normal) { cells_[cell_of(point)].push_back({point, normal}); }

bool PaintedPoints::covers(const Vec3& at, const Vec3& normal) const {
    const Key middle = cell_of(at);
    for (int n = 0; n < 27; ++n) {
        const auto found = cells_.find({middle[0] + n % 3 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n / 9 - 1});
        if (found == cells_.end()) continue;
        for (const Point& point : found->second)
            if (glm::dot(point.at - at, point.at - at) < painted_within * painted_within &&
                glm::dot(point.normal, normal) > 0.0)
                return true;
    }
    return false;
}

PaintedPoints::Key PaintedPoints::cell_of(const Vec3& at) {
    const Vec3 cell = glm::floor(at / painted_within);
    return {static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)};
}

}  // namespace tactus::render
