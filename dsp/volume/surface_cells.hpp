// SPDX-License-Identifier: Apache-2.0
// Rasterises triangles to a grid: which triangles are near a layer of samples, and which cells they cross.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/geometry/iso_surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::volume {

/// Index range, inclusive; empty when low > high.
struct IndexBox {
    std::array<int, 3> low, high;
};

/// The samples of `layout` in a triangle's bounding box enlarged by `margin` (m) on all sides.
IndexBox samples_near(const Grid& layout, const std::array<Vec3, 3>& corners, double margin);

std::array<Vec3, 3> corners_of(const geometry::TriangleSurface& surface, std::int32_t triangle);

/// Triangles sorted by layers of samples (third axis), ascending in each layer: those whose bounding box, enlarged by
/// `margin` (m), reaches it. Layers are independent, so they can be processed in parallel.
class TriangleLayers {
public:
    TriangleLayers(const Grid& layout, const geometry::TriangleSurface& surface, double margin);
    std::span<const std::int32_t> operator[](int k) const {
        const auto n = static_cast<std::size_t>(k);
        return std::span(triangles_).subspan(starts_[n], starts_[n + 1] - starts_[n]);
    }

private:
    std::vector<std::size_t> starts_;
    std::vector<std::int32_t> triangles_;
};

/// The cells (between eight samples) that contain a part of the surface. Cell n has a surface point at[n], the nearest
/// to its middle (in samples from the origin), and the triangles triangle[start[n]] … triangle[start[n + 1] − 1], the
/// first of which contains that point.
struct SurfaceCells {
    std::vector<glm::vec3> at;
    std::vector<std::size_t> start{0};
    std::vector<std::int32_t> triangle;
};
SurfaceCells surface_cells(const Grid& layout, const geometry::TriangleSurface& surface, const RunJobs& run);

/// The samples i of row (j, k), within first … last, that lie within `reach` (m) of the plane through `corner` with the
/// unit normal `normal`; `shift` offsets the row (m). A zero normal leaves the range unchanged.
struct PlaneRow {
    Vec3 corner, normal;
    double reach;

    void narrow(const Grid& layout, const Vec3& shift, int j, int k, int& first, int& last) const;
};

}  // namespace tactus::volume
