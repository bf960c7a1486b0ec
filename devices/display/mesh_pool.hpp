// SPDX-License-Identifier: Apache-2.0
// Meshes in GPU memory. A mesh consists of parts, such as the bricks of a bone, that are replaced one by one; all
// visible parts are drawn with one call. Distant meshes may be drawn with fewer triangles (level of detail).
#pragma once

#include "dsp/display/camera.hpp"
#include "dsp/geometry/brick_surface.hpp"
#include "dsp/geometry/coarse_surface.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <vector>

namespace tactus::display {

/// The bounding box of its vertices.
Bounds bounds_of(const geometry::SurfacePatch& patch);

/// Allocates ranges of a buffer in powers of two, so that freed ranges can be reused.
class BufferShelf {
public:
    /// Returns the first element of a range of at least `count`. `end()` may grow.
    std::size_t take(std::size_t count);
    void give_back(std::size_t first, std::size_t count);
    std::size_t end() const { return end_; }
    static std::size_t room_for(std::size_t count);

private:
    std::map<std::size_t, std::vector<std::size_t>> free_;  // free ranges by size
    std::size_t end_ = 0;
};

/// A part of a mesh's triangles, in the order in which all are drawn.
struct TriangleSpan {
    std::size_t first = 0, most = std::numeric_limits<std::size_t>::max();
};

/// All meshes of one OpenGL context, which must be current in every call.
class MeshPool {
public:
    using Mesh = int;

    MeshPool();
    ~MeshPool();
    MeshPool(const MeshPool&) = delete;
    MeshPool& operator=(const MeshPool&) = delete;

    Mesh make();
    /// Creates a mesh with levels of detail by CoarseSurface; `grid`: the grid of its parts.
    Mesh make(const geometry::SurfaceGrid& grid);
    void remove(Mesh mesh);
    /// Replaces a part; an empty part removes it. Throws Error when a triangle refers to a missing vertex.
    void set_part(Mesh mesh, std::uint32_t part, const geometry::SurfacePatch& patch);
    /// The same with levels of detail computed before; `coarse`: from CoarseSurface, for a mesh with a grid.
    void set_part(Mesh mesh, std::uint32_t part, const geometry::SurfacePatch& patch,
                  const geometry::CoarseSurface::Levels& coarse);
    /// Draws the visible parts in a frame of `width` × `height` pixels; `to_clip` maps the mesh frame to clip space.
    /// `grain`: largest width in pixels of a level-of-detail cell at the nearest point; 0: all triangles. Returns the
    /// number of triangles drawn; with a span, fewer than `most` when the mesh ends.
    std::size_t draw(Mesh mesh, const Mat4& to_clip, int width, int height, double grain, TriangleSpan span = {}) const;
    std::size_t triangles(Mesh mesh) const;  ///< total
    /// Increases whenever a mesh changes.
    std::uint64_t changes() const { return changes_; }

private:
    struct Place {
        std::size_t first_vertex = 0, vertices = 0, first_index = 0, indices = 0;
    };
    struct Part {
        std::array<Place, 1 + geometry::CoarseSurface::factors.size()> levels;  // full detail first
        Bounds bounds;
    };
    struct Parts {
        std::map<std::uint32_t, Part> of;
        std::optional<geometry::SurfaceGrid> grid;
        bool is_used = false;
    };

    Part* replace_part(Mesh mesh, std::uint32_t number, const geometry::SurfacePatch& patch);
    void put_levels(Part& part, const geometry::CoarseSurface::Levels& coarse);
    Place put(const geometry::SurfacePatch& patch);
    void give_back(const Part& part);
    std::size_t level_for(const Parts& parts, const Mat4& to_clip, int width, int height, double grain) const;
    void ensure(std::uint32_t& buffer, std::size_t& size, std::size_t wanted);
    void describe_vertices() const;

    std::vector<Parts> meshes_;
    geometry::CoarseSurface coarse_;
    std::uint64_t changes_ = 0;
    // Scratch buffers for the driver.
    mutable std::vector<const Part*> seen_;
    mutable std::vector<std::int32_t> counts_, bases_;
    mutable std::vector<const void*> offsets_;
    BufferShelf vertex_shelf_, index_shelf_;
    std::uint32_t array_ = 0, vertex_buffer_ = 0, index_buffer_ = 0;
    std::size_t vertex_bytes_ = 0, index_bytes_ = 0;
};

}  // namespace tactus::display
