// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/as_scanned.hpp"

#include <glm/geometric.hpp>

#include <cmath>

namespace tactus::fit {

namespace {

/// Whether a point lies on the other surface with opposite normals, as in gap_between.
bool touches(const contact::SurfacePoint& point, const Pose& place, const contact::Voxmap& other,
             const AsScannedSettings& settings) noexcept {
    const volume::Sample here = other.sample(place.apply(point.position));
    return here.inside && here.value < settings.touching && here.value > -2.0 * settings.moved &&
           glm::dot(place.rotate(point.normal), here.gradient) < -0.3;
}

}  // namespace

bool is_as_scanned(std::span<const contact::SurfacePoint> points, const Pose& place, const contact::Voxmap& other,
                   const Pose& scanned, const AsScannedSettings& settings) noexcept {
    double area = 0.0, ways = 0.0, area_there = 0.0;
    for (const contact::SurfacePoint& p : points) {
        if (touches(p, place, other, settings)) area_there += p.area;
        if (!touches(p, scanned, other, settings)) continue;
        const Vec3 translation = place.apply(p.position) - scanned.apply(p.position);
        area += p.area;
        ways += p.area * glm::dot(translation, translation);
    }
    return area >= settings.min_area && area >= settings.share * area_there && std::sqrt(ways / area) < settings.moved;
}

}  // namespace tactus::fit
