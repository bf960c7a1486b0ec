// SPDX-License-Identifier: Apache-2.0
#include "assets/library/flap_bones.hpp"

#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/volume/grid.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <utility>

namespace tactus::library {

namespace {

constexpr double half_arch = 44.0 * mm, arch_depth = 62.0 * mm, arch_back = 20.0 * mm;

/// Smooth union: where both are within `k`, a fillet (polynomial smooth minimum; Quilez 2013).
double join(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - 0.25 * h * h * k;
}

/// Signed distance of a rectangle of half sizes `half` with rounded corners.
double rounded_box(double x, double y, double half_x, double half_y, double round) {
    const double qx = std::abs(x) - (half_x - round), qy = std::abs(y) - (half_y - round);
    return std::hypot(std::max(qx, 0.0), std::max(qy, 0.0)) + std::min(std::max(qx, qy), 0.0) - round;
}

/// First-order distance to an ellipsoid.
double ellipsoid(const Vec3& p, const Vec3& radii) {
    const Vec3 a = p / radii, b = p / (radii * radii);
    const double r = glm::length(a), steep = glm::length(b);
    return steep > 1e-9 ? r * (r - 1.0) / steep : -std::min({radii.x, radii.y, radii.z});
}

using Outline = std::array<std::array<double, 2>, 13>;
// A ramus seen from the side, mm: y (posterior), z (superior).
constexpr Outline ramus{{{-10.0, -13.0},
                         {12.0, -14.0},
                         {24.0, -9.0},
                         {29.0, 4.0},
                         {32.0, 30.0},
                         {33.0, 46.0},
                         {27.0, 50.0},
                         {22.0, 42.0},
                         {16.0, 38.0},
                         {9.0, 43.0},
                         {4.0, 50.0},
                         {1.0, 34.0},
                         {-6.0, 10.0}}};

/// Signed distance to a polygon in the plane, mm.
double polygon(const Outline& corners, double x, double y) {
    double least = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (std::size_t n = 0, m = corners.size() - 1; n < corners.size(); m = n++) {
        const auto [ax, ay] = corners[n];
        const auto [bx, by] = corners[m];
        const double ex = bx - ax, ey = by - ay, wx = x - ax, wy = y - ay;
        const double t = std::clamp((wx * ex + wy * ey) / (ex * ex + ey * ey), 0.0, 1.0);
        least = std::min(least, std::hypot(wx - t * ex, wy - t * ey));
        if ((ay > y) != (by > y) && x < ex * (y - ay) / ey + ax) inside = !inside;
    }
    return inside ? -least : least;
}

struct ArchPlace {
    double across, angle;  // m to the arch in the horizontal plane, and where
};

class Arch {
public:
    Arch() {
        for (std::size_t n = 0; n < points_.size(); ++n) points_[n] = arch_point(angle(static_cast<double>(n)));
    }
    ArchPlace nearest(const Vec3& p) const {
        ArchPlace best{std::numeric_limits<double>::infinity(), 0.0};
        for (std::size_t n = 0; n + 1 < points_.size(); ++n) {
            const Vec3 e = points_[n + 1] - points_[n];
            const double wx = p.x - points_[n].x, wy = p.y - points_[n].y;
            const double t = std::clamp((wx * e.x + wy * e.y) / (e.x * e.x + e.y * e.y), 0.0, 1.0);
            const double d = std::hypot(wx - t * e.x, wy - t * e.y);
            if (d < best.across) best = {d, angle(static_cast<double>(n) + t)};
        }
        return best;
    }

private:
    static double angle(double n) { return (n / 48.0 - 0.5) * std::numbers::pi; }
    std::array<Vec3, 49> points_;
};

double jaw_distance(const Vec3& p, const Arch& arch) {
    const ArchPlace at = arch.nearest(p);
    // Wider towards the lower border, and at the molars.
    const double half = (5.4 + 0.8 * std::abs(std::sin(at.angle)) - 0.05 * p.z / mm) * mm;
    double d = rounded_box(at.across, p.z, half, 14.0 * mm, 5.0 * mm);
    d = join(d, ellipsoid(p - Vec3(0.0, -44.0 * mm, -9.0 * mm), Vec3(13.0, 6.0, 6.0) * mm), 4.0 * mm);
    // The rami lean outwards.
    const double x = std::abs(p.x) - (43.0 * mm + 0.07 * p.z);
    const double side = polygon(ramus, p.y / mm, p.z / mm) * mm;
    const double plate = 1.5 * mm, thick = 3.4 * mm, qx = std::abs(x) - (thick - plate), qs = side;
    const double branch = std::hypot(std::max(qx, 0.0), std::max(qs, 0.0)) + std::min(std::max(qx, qs), 0.0) - plate;
    d = join(d, branch, 5.0 * mm);
    d = join(d, ellipsoid(Vec3(x, p.y - 30.0 * mm, p.z - 51.0 * mm), Vec3(9.0, 4.5, 5.0) * mm), 4.0 * mm);
    // Crowns, 14 in a row.
    constexpr double row = 1.15, pitch = 2.0 * row / 13.0;
    if (std::abs(at.angle) < row + 0.5 * pitch && p.z > 8.0 * mm) {
        const double n = std::round((at.angle + row) / pitch);
        const Vec3 centre = arch_point(n * pitch - row);
        const double molar = std::abs(n * pitch - row) > 0.62 ? 1.0 : 0.0;
        const Vec3 radii = (Vec3(3.2, 3.0, 7.0) + molar * Vec3(1.6, 1.6, -0.5)) * mm;
        d = join(d, ellipsoid(p - Vec3(centre.x, centre.y, 16.0 * mm), radii), 1.5 * mm);
    }
    return d;
}

constexpr double half_fibula = 180.0 * mm;

double fibula_distance(const Vec3& p) {
    const double u = p.z / half_fibula;
    const double x = p.x - 2.0 * mm * (1.0 - u * u), y = p.y + 3.0 * mm * u * u;
    const double r = std::hypot(x, y), angle = std::atan2(y, -x) - 0.5 * u;  // from medial to posterior; twisted
    const double crest = std::remainder(angle + 0.9, 2.0 * std::numbers::pi) / 0.35;
    double radius =
        6.4 * mm *
        (1.0 + 0.08 * std::cos(3.0 * (angle - 1.5)) + 0.05 * std::cos(2.0 * angle) + 0.14 * std::exp(-crest * crest));
    // Head and malleolus are wider than the shaft; the malleolus is flat.
    const double head = std::exp(-std::pow((p.z - 172.0 * mm) / (17.0 * mm), 2)),
                 ankle = std::exp(-std::pow((p.z + 168.0 * mm) / (22.0 * mm), 2));
    radius += head * 6.0 * mm + ankle * (4.0 * mm + 2.2 * mm * std::cos(2.0 * (angle - 1.5)));
    const double end = std::abs(p.z) - half_fibula;
    const double qr = r - radius, round = 5.0 * mm;
    const double a = std::max(qr + round, 0.0), b = std::max(end + round, 0.0);
    return std::hypot(a, b) + std::min(std::max(qr, end) + round, 0.0) - round;
}

template <class Distance>
geometry::TriangleSurface surface_in(const Vec3& low, const Vec3& high, double voxel, const Distance& distance) {
    volume::Grid grid;
    for (int a = 0; a < 3; ++a)
        grid.size[static_cast<std::size_t>(a)] = static_cast<int>(std::ceil((high[a] - low[a]) / voxel)) + 1;
    grid.origin = low;
    grid.spacing = Vec3(voxel);
    grid.values.reserve(grid.count());
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i)
                grid.values.push_back(static_cast<float>(distance(grid.position(i, j, k))));
    return mesh::export_surface(grid);
}

}  // namespace

Vec3 arch_point(double angle) { return {half_arch * std::sin(angle), arch_back - arch_depth * std::cos(angle), 0.0}; }

Vec3 arch_direction(double angle) {
    return glm::normalize(Vec3(half_arch * std::cos(angle), arch_depth * std::sin(angle), 0.0));
}

geometry::TriangleSurface make_jaw_surface() {
    const Arch arch;
    return surface_in(Vec3(-60.0, -56.0, -21.0) * mm, Vec3(60.0, 40.0, 60.0) * mm, 1.0 * mm,
                      [&](const Vec3& p) { return jaw_distance(p, arch); });
}

geometry::TriangleSurface make_fibula_surface() {
    return surface_in(Vec3(-18.0, -20.0, -184.0) * mm, Vec3(20.0, 18.0, 184.0) * mm, 0.8 * mm, fibula_distance);
}

geometry::TriangleSurface make_tumour_surface() {
    constexpr double angle = 0.4;
    const Vec3 middle = arch_point(angle) + Vec3(0.0, 0.0, 2.0 * mm), along = arch_direction(angle),
               across = glm::cross(Vec3(0.0, 0.0, 1.0), along);
    return surface_in(middle - Vec3(14.0 * mm), middle + Vec3(14.0 * mm), 0.7 * mm, [&](const Vec3& p) {
        const Vec3 d = p - middle;
        const double size =
            glm::length(Vec3(glm::dot(d, along) / (10.0 * mm), glm::dot(d, across) / (6.5 * mm), d.z / (7.5 * mm)));
        return (size - 1.0) * 6.5 * mm;
    });
}

geometry::TriangleSurface mirrored(geometry::TriangleSurface surface) {
    for (Vec3& v : surface.vertices) v.x = -v.x;
    for (auto& t : surface.triangles) std::swap(t[1], t[2]);
    return surface;
}

}  // namespace tactus::library
