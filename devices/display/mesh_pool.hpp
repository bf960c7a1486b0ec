// SPDX-License-Identifier: Apache-2.0
// Meshes that stay on the graphics card. A mesh is made of parts, such as the bricks of a bone, that are replaced one by
// one; however many parts it has, it is drawn by one call.
#pragma once

#include "dsp/view/brick_surface.hpp"
#include "dsp/view/camera.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace tactus {

/// The box around its vertices.
Bounds bounds_of(const SurfacePatch& patch);

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
    void remove(Mesh mesh);
    /// Replaces one part; an empty one takes it away. Throws Error when a triangle names a vertex that is not there.
    void set_part(Mesh mesh, std::uint32_t part, const SurfacePatch& patch);
    void draw(Mesh mesh) const;
    std::size_t triangles(Mesh mesh) const;

private:
    struct Part {
        std::size_t first_vertex = 0, vertices = 0, first_index = 0, indices = 0;
    };
    struct Parts {
        std::map<std::uint32_t, Part> of;
        // What the driver is given, in the same order.
        mutable std::vector<std::int32_t> counts, bases;
        mutable std::vector<const void*> offsets;
        mutable bool is_listed = false;
        bool is_used = false;
    };

    void give_back(const Part& part);
    void ensure(std::uint32_t& buffer, std::size_t& size, std::size_t wanted);
    void describe_vertices() const;

    std::vector<Parts> meshes_;
    BufferShelf vertex_shelf_, index_shelf_;
    std::uint32_t array_ = 0, vertex_buffer_ = 0, index_buffer_ = 0;
    std::size_t vertex_bytes_ = 0, index_bytes_ = 0;
};

}  // namespace tactus
