// SPDX-License-Identifier: Apache-2.0
#include "tools/render/flap_scene.hpp"

#include "assets/mesh/mesh.hpp"
#include "dsp/vessel/line_branch.hpp"
#include "dsp/vessel/tube_surface.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus::render {

namespace {

constexpr double site_radius = 2e-3;  // m

geometry::TriangleSurface surface_of(const reconstruction::Block& block) {
    geometry::TriangleSurface box;
    // Each face has corners of its own, for flat shading.
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const int first = static_cast<int>(box.vertices.size()), u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (const auto& [a, b] : {std::array{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
                Vec3 corner(0.0);
                corner[axis] = side * block.half[axis];
                corner[u] = a * block.half[u];
                corner[v] = side * b * block.half[v];
                box.vertices.push_back(block.centre + block.axes * corner);
            }
            box.triangles.push_back({first, first + 1, first + 2});
            box.triangles.push_back({first, first + 2, first + 3});
        }
    return box;
}

}  // namespace

display::PictureMesh picture_mesh(const geometry::TriangleSurface& surface, const Pose& pose,
                                  std::span<const Vec3> colours) {
    const std::vector<Vec3> normals = mesh::normals_of(surface);
    display::PictureMesh mesh;
    for (std::size_t n = 0; n < surface.vertices.size(); ++n) {
        const Vec3 p = pose.apply(surface.vertices[n]);
        const Vec3 normal = pose.rotate(normals[n]), colour = colours[colours.size() > 1 ? n : 0];
        for (int axis = 0; axis < 3; ++axis) {
            mesh.positions.push_back(static_cast<float>(p[axis]));
            mesh.normals.push_back(static_cast<float>(normal[axis]));
            mesh.colours.push_back(static_cast<float>(colour[axis]));
        }
    }
    for (const auto& t : surface.triangles)
        for (const int corner : t) mesh.triangles.push_back(static_cast<std::uint32_t>(corner));
    return mesh;
}

display::PictureMesh tube_mesh(const std::vector<Vec3>& line, double radius, const Vec3& colour) {
    return picture_mesh(vessel::tube_surface(vessel::branch_of_line(line, radius)), {}, {&colour, 1});
}

display::PictureMesh ball_mesh(const Vec3& centre, double radius, const Vec3& colour) {
    geometry::TriangleSurface ball;
    constexpr int round = 16, rings = 9;
    for (int ring = 0; ring < rings; ++ring)
        for (int n = 0; n < round; ++n) {
            const double polar = std::numbers::pi * ring / (rings - 1), a = 2.0 * std::numbers::pi * n / round;
            ball.vertices.push_back(
                centre + radius * Vec3(std::sin(polar) * std::cos(a), std::sin(polar) * std::sin(a), std::cos(polar)));
        }
    const auto at = [](int ring, int n) { return ring * round + n % round; };
    for (int ring = 0; ring + 1 < rings; ++ring)
        for (int n = 0; n < round; ++n) {
            ball.triangles.push_back({at(ring, n), at(ring + 1, n), at(ring, n + 1)});
            ball.triangles.push_back({at(ring, n + 1), at(ring + 1, n), at(ring + 1, n + 1)});
        }
    return picture_mesh(ball, {}, {&colour, 1});
}

std::vector<Hardware> hardware_of(const reconstruction::Flap& flap) {
    std::vector<Hardware> all;
    for (const reconstruction::Plate& plate : flap.plates) {
        Hardware& made = all.emplace_back("plate " + plate.name, plate_colour);
        for (const reconstruction::Block& block : reconstruction::blocks_of(plate))
            made.meshes.push_back(picture_mesh(surface_of(block), {}, {&plate_colour, 1}));
        for (const reconstruction::Screw& screw : plate.screws) {
            // The head stands above the plate.
            const Vec3 top = screw.head - (plate.thickness + 0.8e-3) * screw.axis;
            made.meshes.push_back(
                tube_mesh({screw.head, screw.head + screw.length * screw.axis}, 0.5 * screw.diameter, screw_colour));
            made.meshes.push_back(tube_mesh({top, screw.head}, screw.diameter, screw_colour));
        }
    }
    for (const reconstruction::DentalImplant& implant : flap.implants)
        all.emplace_back("implant " + implant.name, implant_colour)
            .meshes.push_back(tube_mesh({implant.head, implant.head + implant.length * implant.axis},
                                        0.5 * implant.diameter, implant_colour));
    return all;
}

void add_hardware(std::vector<display::PictureMesh>& meshes, std::vector<PictureLabel>& labels,
                  const reconstruction::Flap& flap) {
    for (Hardware& one : hardware_of(flap))
        for (display::PictureMesh& mesh : one.meshes) meshes.push_back(std::move(mesh));
    for (const reconstruction::Plate& plate : flap.plates)
        if (!plate.points.empty()) labels.push_back({plate.name, plate.points[plate.points.size() / 2], plate_colour});
    for (const reconstruction::DentalImplant& implant : flap.implants)
        labels.push_back({implant.name, implant.head, implant_colour});
    for (const reconstruction::RecipientSite& site : flap.sites) {
        const Vec3 colour = site.kind == reconstruction::VesselKind::artery ? flap_artery_colour : flap_vein_colour;
        meshes.push_back(ball_mesh(site.at, site_radius, colour));
        labels.push_back({site.name, site.at, colour});
    }
}

std::vector<Hardware> sites_of(const reconstruction::Flap& flap) {
    std::vector<Hardware> all;
    for (const reconstruction::RecipientSite& site : flap.sites) {
        const Vec3 colour = site.kind == reconstruction::VesselKind::artery ? flap_artery_colour : flap_vein_colour;
        all.push_back({"site " + site.name, colour, {ball_mesh(site.at, site_radius, colour)}});
    }
    return all;
}

void add_vessels(std::vector<display::PictureMesh>& meshes, std::vector<PictureLabel>& labels,
                 std::span<const reconstruction::PlacedVessel> vessels) {
    for (const reconstruction::PlacedVessel& vessel : vessels) {
        const Vec3 colour = vessel.kind == reconstruction::VesselKind::artery ? flap_artery_colour : flap_vein_colour;
        for (const std::vector<Vec3>& line : vessel.lines)
            if (line.size() > 1) meshes.push_back(tube_mesh(line, vessel.radius, colour));
        if (!vessel.lines.empty() && !vessel.lines[0].empty())
            labels.push_back({vessel.name, vessel.lines[0][vessel.lines[0].size() / 2], colour});
    }
}

}  // namespace tactus::render
