// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/paint.hpp"

#include "dsp/fit/surface_brush.hpp"

#include <vector>

namespace tactus::plan {

std::size_t paint_fracture(std::span<contact::SurfacePoint> points, const contact::Voxmap& bone, const Pose& into_bone,
                           double spill) {
    constexpr double depth = 0.3e-3;
    std::vector<Vec3> inside;
    for (contact::SurfacePoint& p : points) {
        const volume::Sample here = bone.sample(into_bone.apply(p.position));
        if (!here.inside || !(here.value < -depth) || p.label == contact::surface_label::as_scanned) continue;
        p.label = contact::surface_label::fracture;
        inside.push_back(p.position);
    }
    if (!(spill > 0.0)) return inside.size();
    fit::SurfaceBrush brush({points.begin(), points.end()});
    for (const Vec3& place : inside) brush.stroke(place, spill, contact::surface_label::fracture);
    std::size_t count = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
        count += brush.points()[n].label == contact::surface_label::fracture;
        points[n].label = brush.points()[n].label;
    }
    return count;
}

}  // namespace tactus::plan
