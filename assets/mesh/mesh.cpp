// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/mesh.hpp"

#include "dsp/core/stop.hpp"
#include "dsp/geometry/surface_volume.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace tactus::mesh {

namespace {

const Vec3& corner(const geometry::TriangleSurface& mesh, const std::array<int, 3>& triangle, std::size_t n) {
    return mesh.vertices[static_cast<std::size_t>(triangle[n])];
}

}  // namespace

std::vector<Vec3> normals_of(const geometry::TriangleSurface& mesh) {
    std::vector<Vec3> normals(mesh.vertices.size(), Vec3(0.0));
    for (const auto& t : mesh.triangles) {
        const Vec3 normal =
            glm::cross(corner(mesh, t, 1) - corner(mesh, t, 0), corner(mesh, t, 2) - corner(mesh, t, 0));
        for (const int n : t) normals[static_cast<std::size_t>(n)] += normal;
    }
    for (Vec3& normal : normals) {
        const double length = glm::length(normal);
        normal = length > 0.0 ? normal / length : Vec3(0.0, 0.0, 1.0);
    }
    return normals;
}

Mesh surface_of(const volume::Grid& distance) {
    Mesh mesh;
    static_cast<geometry::TriangleSurface&>(mesh) = geometry::iso_surface(distance, 0.0f, false);
    mesh.normals = normals_of(mesh);
    const auto& size = distance.size;
    for (std::size_t n = 0; n < mesh.vertices.size(); ++n) {
        const Vec3& vertex = mesh.vertices[n];
        const Vec3 u = (vertex - distance.origin) / distance.spacing;
        const int i = static_cast<int>(u.x + 0.5), j = static_cast<int>(u.y + 0.5), k = static_cast<int>(u.z + 0.5);
        const int x0 = std::max(i - 1, 0), x1 = std::min(i + 1, size[0] - 1), y0 = std::max(j - 1, 0);
        const int y1 = std::min(j + 1, size[1] - 1), z0 = std::max(k - 1, 0), z1 = std::min(k + 1, size[2] - 1);
        const Vec3 slope =
            Vec3(distance.at(x1, j, k) - distance.at(x0, j, k), distance.at(i, y1, k) - distance.at(i, y0, k),
                 distance.at(i, j, z1) - distance.at(i, j, z0)) /
            (Vec3(x1 - x0, y1 - y0, z1 - z0) * distance.spacing);
        const double length = glm::length(slope);
        // Prefer the gradient, which is smoother, except in walls one sample thick, where it is meaningless.
        if (glm::dot(slope, mesh.normals[n]) > 0.5 * length && length > 0.5) mesh.normals[n] = slope / length;
    }
    return mesh;
}

double volume_of(const geometry::TriangleSurface& mesh) { return geometry::volume_of(mesh); }

double area_of(const geometry::TriangleSurface& mesh) {
    double twice = 0.0;
    for (const auto& t : mesh.triangles)
        twice +=
            glm::length(glm::cross(corner(mesh, t, 1) - corner(mesh, t, 0), corner(mesh, t, 2) - corner(mesh, t, 0)));
    return 0.5 * twice;
}

MeshTopology topology_of(const geometry::TriangleSurface& mesh) {
    struct Edge {
        int low, high, forward;
        bool operator<(const Edge& other) const { return std::pair(low, high) < std::pair(other.low, other.high); }
    };
    std::vector<Edge> edges;
    std::vector<int> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&parent](int v) {
        while (parent[static_cast<std::size_t>(v)] != v) {
            parent[static_cast<std::size_t>(v)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(v)])];
            v = parent[static_cast<std::size_t>(v)];
        }
        return v;
    };
    for (const auto& t : mesh.triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            const int a = t[c], b = t[(c + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), a < b});
            parent[static_cast<std::size_t>(root(a))] = root(b);
        }
    leave_if_stopped();
    std::sort(edges.begin(), edges.end());
    leave_if_stopped();
    MeshTopology found;
    for (std::size_t n = 0; n < edges.size();) {
        std::size_t count = 0;
        int forward = 0;
        for (const Edge first = edges[n]; n < edges.size() && edges[n].low == first.low && edges[n].high == first.high;
             ++n)
            ++count, forward += edges[n].forward;
        found.boundary_edges += count == 1;
        found.non_manifold_edges += count > 2;
        found.flipped_edges += count == 2 && forward != 1;
    }
    std::vector<int> number(mesh.vertices.size(), -1);
    for (const auto& t : mesh.triangles) {
        int& id = number[static_cast<std::size_t>(root(t[0]))];
        if (id < 0) id = static_cast<int>(found.components++);
        found.component_of.push_back(id);
    }
    return found;
}

}  // namespace tactus::mesh
