// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/write_mesh.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/three_mf.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/surface_net.hpp"
#include "dsp/volume/cubic_interpolant.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>

namespace tactus::mesh {

namespace {

static_assert(std::endian::native == std::endian::little, "STL and PLY are written as the bytes lie in memory");

constexpr std::string_view space = "SPACE=LPS";

template <typename T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) append(bytes, static_cast<float>(v[axis]));
}

std::string stl_of(std::span<const ColouredSurface> surfaces, std::uint32_t triangles) {
    // The header must not begin with "solid": readers would parse the file as text.
    std::string bytes = fmt::format("{:<80}", fmt::format("Tactus. {} unit=mm", space));
    bytes.reserve(84 + std::size_t{50} * triangles);
    append(bytes, triangles);
    for (const auto& [surface, colour] : surfaces)
        for (const auto& t : surface.triangles) {
            const Vec3 &a = surface.vertices[static_cast<std::size_t>(t[0])],
                       &b = surface.vertices[static_cast<std::size_t>(t[1])];
            const Vec3& c = surface.vertices[static_cast<std::size_t>(t[2])];
            const Vec3 normal = glm::cross(b - a, c - a);
            const double length = glm::length(normal);
            append(bytes, length > 0.0 ? normal / length : Vec3(0.0));
            for (const Vec3* corner : {&a, &b, &c}) append(bytes, *corner * 1e3);
            append(bytes, std::uint16_t{0});
        }
    return bytes;
}

std::string ply_of(std::span<const ColouredSurface> surfaces, std::uint32_t triangles) {
    std::size_t vertices = 0;
    for (const auto& each : surfaces) vertices += each.surface.vertices.size();
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment {}\ncomment unit=mm\nelement vertex {}\nproperty float "
        "x\nproperty "
        "float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face "
        "{}\nproperty list uchar int vertex_indices\nend_header\n",
        space, vertices, triangles);
    for (const auto& [surface, colour] : surfaces)
        for (const Vec3& v : surface.vertices) {
            append(bytes, v * 1e3);
            for (int n = 0; n < 3; ++n)
                append(bytes, static_cast<std::uint8_t>(std::clamp(colour[n], 0.0, 1.0) * 255.0 + 0.5));
        }
    std::int32_t first = 0;
    for (const auto& [surface, colour] : surfaces) {
        for (const auto& t : surface.triangles) {
            append(bytes, std::uint8_t{3});
            for (const int corner : t) append(bytes, static_cast<std::int32_t>(first + corner));
        }
        first += static_cast<std::int32_t>(surface.vertices.size());
    }
    return bytes;
}

// Two Newton steps onto the interpolated surface, each at most a quarter of a cell.
void settle(geometry::TriangleSurface& surface, const volume::Grid& distance) {
    const volume::CubicInterpolant f{distance};
    const double cell = std::min({distance.spacing.x, distance.spacing.y, distance.spacing.z});
    for (Vec3& v : surface.vertices)
        for (int step = 0; step < 2; ++step) {
            const auto here = f((v - distance.origin) / distance.spacing);
            const double steep = glm::dot(here.gradient, here.gradient);
            if (!(steep > 0.0)) break;
            Vec3 move = -here.gradient * (here.value / steep);
            if (const double length = glm::length(move); length > 0.25 * cell) move *= 0.25 * cell / length;
            v += move;
        }
}

}  // namespace

void write_mesh(std::span<const ColouredSurface> surfaces, const std::filesystem::path& path) {
    std::size_t triangles = 0;
    for (const auto& each : surfaces) triangles += each.surface.triangles.size();
    if (triangles == 0) throw Error(fmt::format("{}: the surface has no triangles; nothing is written", path.string()));
    if (triangles > 500'000'000)
        throw Error(fmt::format("{}: {} triangles are too many for a file", path.string(), triangles));
    const std::string kind = path.extension().string();
    if (kind == ".stl") file::write_whole_file(path, stl_of(surfaces, static_cast<std::uint32_t>(triangles)));
    else if (kind == ".ply") file::write_whole_file(path, ply_of(surfaces, static_cast<std::uint32_t>(triangles)));
    else if (kind == ".3mf") file::write_whole_file(path, three_mf_of(surfaces));
    else throw Error(fmt::format("{}: a mesh is written as .stl, .ply or .3mf", path.string()));
}

geometry::TriangleSurface export_surface(const volume::Grid& distance) {
    geometry::SurfaceNet net = geometry::surface_net(distance, 0.0f, false);
    geometry::TriangleSurface surface = topology_of(net).is_watertight()
                                            ? static_cast<geometry::TriangleSurface>(std::move(net))
                                            : geometry::iso_surface(distance, 0.0f, false);
    settle(surface, distance);
    return surface;
}

}  // namespace tactus::mesh
