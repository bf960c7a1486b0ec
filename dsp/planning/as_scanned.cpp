// SPDX-License-Identifier: Apache-2.0
#include "dsp/planning/as_scanned.hpp"

#include "dsp/planning/gap.hpp"

#include <glm/geometric.hpp>

#include <cmath>

namespace tactus {

bool is_as_scanned(std::span<const SurfacePoint> points, const Pose& place, const Voxmap& other,
                   const AsScannedSettings& settings) {
    const GapSettings gap{.near = 2.0 * settings.moved, .contact = settings.touching};
    const SurfaceGap scanned = gap_between(points, {}, other, {}, gap);
    if (scanned.contact_area < settings.least_area) return false;
    if (scanned.contact_area < settings.share * gap_between(points, place, other, {}, gap).contact_area) return false;
    double area = 0.0, ways = 0.0;
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (!(scanned.distance[n] < settings.touching)) continue;
        const Vec3 way = place.apply(points[n].position) - points[n].position;
        area += points[n].area;
        ways += points[n].area * glm::dot(way, way);
    }
    return std::sqrt(ways / area) < settings.moved;
}

}  // namespace tactus
