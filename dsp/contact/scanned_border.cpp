// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/scanned_border.hpp"

#include "dsp/geometry/point_tree.hpp"

#include <glm/geometric.hpp>

namespace tactus::contact {

namespace {

constexpr double reach = 1.25;  // voxels

}  // namespace

std::size_t mark_as_scanned(std::span<SurfacePoint> points, const ScannedBorder& border) {
    if (border.faces.empty()) return 0;
    std::vector<Vec3> faces;
    faces.reserve(border.faces.size());
    for (const Vec3& face : border.faces) faces.push_back(face / border.voxel);
    const geometry::PointTree tree(faces);
    std::size_t count = 0;
    for (SurfacePoint& p : points) {
        const Vec3 at = p.position / border.voxel;
        if (!(glm::distance(faces[tree.nearest(at)], at) < reach)) continue;
        p.label = surface_label::as_scanned;
        ++count;
    }
    return count;
}

void remove_paint(std::span<SurfacePoint> points) noexcept {
    for (SurfacePoint& p : points)
        if (p.label != surface_label::as_scanned) p.label = surface_label::none;
}

double as_scanned_area(std::span<const SurfacePoint> points) noexcept {
    double area = 0.0;
    for (const SurfacePoint& p : points) area += p.label == surface_label::as_scanned ? p.area : 0.0;
    return area;
}

}  // namespace tactus::contact
