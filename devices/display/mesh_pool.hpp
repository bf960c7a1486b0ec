// SPDX-License-Identifier: Apache-2.0
// Meshes that stay on the graphics card. A mesh is made of parts, such as the bricks of a bone, that are replaced one by
// one; those of its parts that are in the picture are drawn by one call, however many they are. What is seen from afar is
// drawn with fewer triangles where the picture may.
#pragma once

#include "dsp/display/camera.hpp"
#include "dsp/geometry/brick_surface.hpp"
#include "dsp/geometry/coarse_surface.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace tactus::display {

/// The box around its vertices.
Bounds bounds_of(const geometry::SurfacePatch& patch);

/// Places in a long buffer, in powers of two, so that what is given back fits again.
class BufferShelf {
public:
    /// First element of a place for at least `count`. `end()` may grow.
    std::size_t take(std::size_t count);
    void give_back(std::size_t first, std::size_t count);
    std::size_t end() const { return end_; }
    static std::size_t room_for(std::size_t count);

private:
    std::map<std::size_t, std::vector<std::size_t>> free_;  // by size
    std::size_t end_ = 0;
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
    /// One that is also kept with the cells of CoarseSurface; `grid`: what its parts are made from.
    Mesh make(const geometry::SurfaceGrid& grid);
    void remove(Mesh mesh);
    /// Replaces one part; an empty one takes it away. Throws Error when a triangle names a vertex that is not there.
    void set_part(Mesh mesh, std::uint32_t part, const geometry::SurfacePatch& patch);
    /// Draws the parts that are within a picture of `width` × `height` pixels; `to_clip` starts from the frame of the mesh.
    /// Its cells may be `grain` pixels wide where it is nearest, 0: all triangles. Returns how many were drawn.
    std::size_t draw(Mesh mesh, const Mat4& to_clip, int width, int height, double grain) const;
    std::size_t triangles(Mesh mesh) const;  ///< all of them
    /// Rises whenever a mesh changes.
    std::uint64_t changes() const { return changes_; }

private:
    struct Place {
        std::size_t first_vertex = 0, vertices = 0, first_index = 0, indices = 0;
    };
    struct Part {
        std::array<Place, 1 + geometry::CoarseSurface::factors.size()> levels;  // all triangles first
        Bounds bounds;
    };
    struct Parts {
        std::map<std::uint32_t, Part> of;
        std::optional<geometry::SurfaceGrid> grid;
        bool is_used = false;
    };

    Place put(const geometry::SurfacePatch& patch);
    void give_back(const Part& part);
    std::size_t level_for(const Parts& parts, const Mat4& to_clip, int width, int height, double grain) const;
    void ensure(std::uint32_t& buffer, std::size_t& size, std::size_t wanted);
    void describe_vertices() const;

    std::vector<Parts> meshes_;
    geometry::CoarseSurface coarse_;
    std::uint64_t changes_ = 0;
    // What the driver is given.
    mutable std::vector<const Part*> seen_;
    mutable std::vector<std::int32_t> counts_, bases_;
    mutable std::vector<const void*> offsets_;
    BufferShelf vertex_shelf_, index_shelf_;
    std::uint32_t array_ = 0, vertex_buffer_ = 0, index_buffer_ = 0;
    std::size_t vertex_bytes_ = 0, index_bytes_ = 0;
};

}  // namespace tactus::display
