// SPDX-License-Identifier: Apache-2.0
// Distance from the samples of a grid to triangles.
#pragma once

#include "dsp/distance/iso_surface.hpp"

#include <cstdint>

namespace tactus {

/// Index of the nearest triangle per sample and the distance to it (m). `layout` gives size, origin and spacing; its
/// values are not read. Exact within 1.5 cells of the surface; farther away triangles are passed on from sample to
/// sample in eight sweep directions, which errs only where a nearer triangle is nearest to none of the
/// sample's neighbours. An empty surface gives an infinite distance and triangle -1.
struct NearestTriangles {
    std::vector<std::int32_t> triangle;
    std::vector<float> distance;
};
NearestTriangles nearest_triangles(const Grid& layout, const TriangleSurface& surface);

/// Winding number of a closed surface at each sample, by signed crossings along x: 1 inside a surface whose triangles
/// are counter-clockwise from outside, 0 outside. Exact: samples on an edge or corner are decided by one consistent
/// infinitesimal shift.
std::vector<std::int16_t> winding_numbers(const Grid& layout, const TriangleSurface& surface);

/// Signed distance to a closed surface at the samples of `layout`, m, negative where the winding number is not 0.
Grid signed_distance(const Grid& layout, const TriangleSurface& surface);

}  // namespace tactus
