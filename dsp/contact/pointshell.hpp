// SPDX-License-Identifier: Apache-2.0
// Pointshell: the surface of a body as points, to be tested against voxmaps (McNeely, Puterbaugh and Troy 1999).
#pragma once

#include "dsp/core/types.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::contact {

/// Label of a surface point. Other values are available to the user. Points labelled `as_scanned` lie where fragments
/// touch in their scan (scanned_border.hpp): they cannot be painted, and they belong to no face and no outer contour of
/// a fit.
namespace surface_label {
inline constexpr std::uint8_t none = 0, fracture = 1, as_scanned = 255;
}

/// One point of a surface. Body frame, m.
struct SurfacePoint {
    Vec3 position{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 1.0};  ///< unit length, outwards
    double area = 0.0;  ///< m² of surface that the point represents
    std::uint8_t label = surface_label::none;
};

inline constexpr int chunk_points = 64;

/// Up to 64 neighbouring points in the layout of the vector kernel: small offsets from the chunk's centre, so that
/// single precision suffices. Unused entries have weight 0.
struct alignas(64) ShellChunk {
    float x[chunk_points], y[chunk_points], z[chunk_points];  ///< m, body frame, from the node's centre
    float nx[chunk_points], ny[chunk_points], nz[chunk_points];  ///< outward normals
    float count[chunk_points];  ///< number of points that this one represents: 1 in a leaf
    float area[chunk_points];  ///< m² of surface that it represents
};

/// A node of the multiresolution tree. The chunk of a leaf holds all its points. The chunk of an inner node holds 64
/// evenly spread points from its children's chunks, each representing those nearest to it: a coarser shell nested in
/// the finer.
struct ShellNode {
    Vec3 centre{0.0, 0.0, 0.0};  ///< one of its points, body frame, m
    double radius = 0.0;  ///< greatest distance from the centre to any point of the node, m
    std::uint32_t first_point = 0, points = 0;  ///< its points, adjacent in the shell's arrays
    std::uint32_t first_child = 0, children = 0;  ///< at most 4, adjacent in `nodes`; none in a leaf
    std::uint32_t held = 0, below = 0;  ///< number of points in its chunk, and in its children's chunks together
};

/// Surface points in the order of a balanced k-d tree (Morton order with planes at medians): neighbours in space are
/// neighbours in memory. Body frame, m. Made by make_pointshell; read-only afterwards.
struct Pointshell {
    static constexpr std::string_view wire_name = "pointshell";

    std::vector<Vec3> position;
    std::vector<Vec3> normal;  ///< unit, out of the body
    std::vector<float> area;  ///< m²
    std::vector<std::uint8_t> label;
    std::vector<ShellNode> nodes;  ///< level by level, the root first; empty without points
    std::vector<ShellChunk> chunks;  ///< one per node
    double reach = 0.0;  ///< greatest distance of a point from the body's origin, m
    Vec3 centroid{0.0, 0.0, 0.0};  ///< mean of the points
    double gyration = 0.0;  ///< root mean square distance of the points from their centroid, m

    std::size_t size() const noexcept { return position.size(); }
    bool empty() const noexcept { return position.empty(); }
    SurfacePoint point(std::size_t i) const { return {position[i], normal[i], static_cast<double>(area[i]), label[i]}; }
};

/// Sorts the points and builds the tree; deterministic. Normals are scaled to unit length; a zero normal stays zero.
/// Throws Error for positions, normals or areas that are not finite, and for negative areas.
Pointshell make_pointshell(std::span<const SurfacePoint> points);

}  // namespace tactus::contact
