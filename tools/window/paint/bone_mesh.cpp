// SPDX-License-Identifier: Apache-2.0
#include "tools/window/paint/bone_mesh.hpp"

#include "dsp/geometry/surface_net.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::window {

namespace {

/// Every `step`th sample of the bone's box: 1 in bone, 0 elsewhere, with a border of zeros so that the net is closed.
volume::Grid inside_of(const analysis::ScanGraph& scan, int step) {
    volume::Grid out;
    const volume::Grid& box = scan.box;
    for (std::size_t axis = 0; axis < 3; ++axis) out.size[axis] = (box.size[axis] - 1) / step + 3;
    out.spacing = box.spacing * static_cast<double>(step);
    out.origin = box.origin - out.spacing;
    out.values.assign(out.count(), 0.0f);
    for (int k = 0; k + 2 < out.size[2]; ++k)
        for (int j = 0; j + 2 < out.size[1]; ++j)
            for (int i = 0; i + 2 < out.size[0]; ++i)
                if (scan.node_of_voxel[box.index(i * step, j * step, k * step)] >= 0)
                    out.at(i + 1, j + 1, k + 1) = 1.0f;
    return out;
}

/// The node nearest to a position, among the eight voxels around it; -1: none.
std::int32_t node_near(const analysis::ScanGraph& scan, const Vec3& p, int step) {
    const volume::Grid& box = scan.box;
    std::int32_t found = -1;
    double least = 1e9;
    const Vec3 at = (p - box.origin) / box.spacing;
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y)),
              z = static_cast<int>(std::floor(at.z));
    for (int k = z + 1 - step; k <= z + step; ++k)
        for (int j = y + 1 - step; j <= y + step; ++j)
            for (int i = x + 1 - step; i <= x + step; ++i) {
                if (i < 0 || j < 0 || k < 0 || i >= box.size[0] || j >= box.size[1] || k >= box.size[2]) continue;
                const std::int32_t node = scan.node_of_voxel[box.index(i, j, k)];
                const double away = glm::length(at - Vec3(i, j, k));
                if (node >= 0 && away < least) least = away, found = node;
            }
    return found;
}

}  // namespace

BoneMesh bone_mesh(const analysis::ScanGraph& scan, const RunJobs& run) {
    const int step = scan.box.count() > 12'000'000 ? 2 : 1;
    const volume::Grid inside = inside_of(scan, step);
    geometry::SurfaceNet net = geometry::surface_net(inside, 0.5f, true);
    geometry::relax(net, inside, 8, run);
    BoneMesh out;
    std::vector<Vec3> normals(net.vertices.size(), Vec3(0.0));
    for (const auto& t : net.triangles) {
        const auto corner = [&](std::size_t n) { return net.vertices[static_cast<std::size_t>(t[n])]; };
        const Vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
        for (const int v : t) {
            normals[static_cast<std::size_t>(v)] += normal;
            out.patch.triangles.push_back(static_cast<std::uint32_t>(v));
        }
    }
    for (std::size_t v = 0; v < net.vertices.size(); ++v) {
        geometry::SurfaceVertex vertex;
        const double length = glm::length(normals[v]);
        for (int axis = 0; axis < 3; ++axis) {
            vertex.position[static_cast<std::size_t>(axis)] = static_cast<float>(net.vertices[v][axis]);
            vertex.normal[static_cast<std::size_t>(axis)] =
                static_cast<std::int16_t>(length > 0.0 ? 32767.0 * normals[v][axis] / length : 0.0);
        }
        out.patch.vertices.push_back(vertex);
        out.node.push_back(node_near(scan, net.vertices[v], step));
        out.bounds.add(net.vertices[v]);
    }
    return out;
}

void colour_mesh(BoneMesh& mesh, const LiveLabelling* labels, const std::vector<std::array<std::uint8_t, 3>>& colours) {
    constexpr std::array<std::uint8_t, 3> bone{226, 214, 188};
    for (std::size_t v = 0; v < mesh.node.size(); ++v) {
        std::array<std::uint8_t, 3> colour = bone;
        if (labels && mesh.node[v] >= 0) {
            const auto n = static_cast<std::size_t>(mesh.node[v]);
            const std::uint8_t seed = labels->seed.empty() ? std::uint8_t{0} : labels->seed[n];
            const std::uint8_t label = labels->label.empty() ? seed : labels->label[n];
            if (label != 0 && label <= colours.size()) {
                colour = colours[label - 1u];
                for (std::size_t c = 0; c < 3; ++c)
                    colour[c] =
                        static_cast<std::uint8_t>(seed != 0 ? 0.7 * colour[c] : 0.55 * colour[c] + 0.45 * bone[c]);
            }
        }
        mesh.patch.vertices[v].colour = {colour[0], colour[1], colour[2], 255};
    }
}

}  // namespace tactus::window
