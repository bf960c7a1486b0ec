// SPDX-License-Identifier: Apache-2.0
#include "assets/fracture/paint.hpp"

#include <glm/geometric.hpp>

#include <vector>

namespace tactus {

std::size_t paint_fracture(std::span<SurfacePoint> points, const Voxmap& bone, const Pose& into_bone, double spill) {
    constexpr double depth = 0.3e-3;
    std::vector<Vec3> inside;
    for (SurfacePoint& p : points) {
        const Sample here = bone.sample(into_bone.apply(p.position));
        if (!here.inside || !(here.value < -depth)) continue;
        p.label = surface_label::fracture;
        inside.push_back(p.position);
    }
    std::size_t count = inside.size();
    if (!(spill > 0.0)) return count;
    for (SurfacePoint& p : points) {
        if (p.label == surface_label::fracture) continue;
        for (const Vec3& q : inside)
            if (glm::dot(p.position - q, p.position - q) < spill * spill) {
                p.label = surface_label::fracture;
                ++count;
                break;
            }
    }
    return count;
}

}  // namespace tactus
