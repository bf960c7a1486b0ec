// SPDX-License-Identifier: Apache-2.0
// Triangle meshes: from files, from a distance grid, and measurements on them.
#pragma once

#include "assets/volume/patient_frame.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::mesh {

/// Triangles with shared vertices (m; after load_mesh the unit of the file), and optionally a unit normal per vertex.
struct Mesh : geometry::TriangleSurface {
    std::vector<Vec3> normals;  ///< empty or one per vertex
};

/// Properties of a mesh file, found by load_mesh.
struct MeshOrigin {
    volume::Frame frame = volume::Frame::lps;       ///< frame of the coordinates in the file
    bool frame_stated = false;      ///< by "SPACE=RAS" or "SPACE=LPS" in a header or comment; else LPS is assumed
    std::optional<double> unit;     ///< m, from "unit=mm", "unit=cm" or "unit=m" in a header or comment
    std::size_t without_area = 0;   ///< triangles dropped because two corners coincide
    std::vector<std::string> notes{};  ///< contents besides triangles, which were ignored
};

/// STL (binary, text), PLY or OBJ. Coordinates in LPS, times `scale`, in double precision; equal points are joined,
/// triangles without area dropped. Throws Error for damaged files, coordinates that are not finite and files without
/// triangles. `origin` may be null.
Mesh load_mesh(const std::filesystem::path& path, double scale = 1.0, MeshOrigin* origin = nullptr);

/// Unit normal per vertex: the mean of those of its triangles, weighted by their areas.
std::vector<Vec3> normals_of(const geometry::TriangleSurface& mesh);

/// The zero surface of a signed distance (m, negative inside). Normals come from its gradient or, where a wall is so
/// thin that the gradient does not define its side, from the triangles.
Mesh surface_of(const volume::Grid& distance);

double volume_of(
    const geometry::TriangleSurface& mesh);  ///< m³, positive if triangles face outwards; mesh must be closed
double area_of(const geometry::TriangleSurface& mesh);    ///< m²

/// Topology of a mesh. Watertight: every edge has two triangles that traverse it in opposite directions.
struct MeshTopology {
    std::size_t boundary_edges = 0;      ///< with one triangle
    std::size_t non_manifold_edges = 0;  ///< with more than two triangles
    std::size_t flipped_edges = 0;       ///< with two triangles that traverse it in the same direction
    std::size_t components = 0;          ///< connected through vertices
    std::vector<int> component_of;       ///< per triangle, in order of first appearance

    bool is_watertight() const { return boundary_edges + non_manifold_edges + flipped_edges == 0; }
};
MeshTopology topology_of(const geometry::TriangleSurface& mesh);

}  // namespace tactus::mesh
