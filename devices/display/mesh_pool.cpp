// SPDX-License-Identifier: Apache-2.0
#include "devices/display/mesh_pool.hpp"

#include "devices/display/gl_program.hpp"
#include "dsp/core/error.hpp"
#include "dsp/display/frustum.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>

namespace tactus::display {

Bounds bounds_of(const geometry::SurfacePatch& patch) {
    Bounds bounds;
    for (const geometry::SurfaceVertex& v : patch.vertices)
        bounds.add(Vec3(static_cast<double>(v.position[0]), static_cast<double>(v.position[1]),
                        static_cast<double>(v.position[2])));
    return bounds;
}

std::size_t BufferShelf::room_for(std::size_t count) { return std::bit_ceil(std::max<std::size_t>(count, 16)); }

std::size_t BufferShelf::take(std::size_t count) {
    const std::size_t room = room_for(count);
    if (auto& places = free_[room]; !places.empty()) {
        const std::size_t first = places.back();
        places.pop_back();
        return first;
    }
    end_ += room;
    return end_ - room;
}

void BufferShelf::give_back(std::size_t first, std::size_t count) { free_[room_for(count)].push_back(first); }

MeshPool::MeshPool() {
    glGenVertexArrays(1, &array_);
    describe_vertices();
}

MeshPool::~MeshPool() {
    glDeleteVertexArrays(1, &array_);
    glDeleteBuffers(1, &vertex_buffer_);
    glDeleteBuffers(1, &index_buffer_);
}

void MeshPool::describe_vertices() const {
    glBindVertexArray(array_);
    glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
    if (vertex_buffer_ == 0) return;
    const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(geometry::SurfaceVertex),
                          at(offsetof(geometry::SurfaceVertex, position)));
    glVertexAttribPointer(1, 3, GL_SHORT, GL_TRUE, sizeof(geometry::SurfaceVertex),
                          at(offsetof(geometry::SurfaceVertex, normal)));
    glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(geometry::SurfaceVertex),
                          at(offsetof(geometry::SurfaceVertex, colour)));
    for (GLuint location = 0; location < 3; ++location) glEnableVertexAttribArray(location);
}

/// Grows the buffer when needed and keeps its content.
void MeshPool::ensure(std::uint32_t& buffer, std::size_t& size, std::size_t wanted) {
    if (wanted <= size) return;
    const std::size_t longer = std::max(wanted, 2 * size);
    GLuint next = 0;
    glGenBuffers(1, &next);
    glBindBuffer(GL_COPY_WRITE_BUFFER, next);
    glBufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(longer), nullptr, GL_DYNAMIC_DRAW);
    if (buffer != 0) {
        glBindBuffer(GL_COPY_READ_BUFFER, buffer);
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, static_cast<GLsizeiptr>(size));
        glDeleteBuffers(1, &buffer);
    }
    buffer = next;
    size = longer;
    describe_vertices();
}

MeshPool::Mesh MeshPool::make() {
    const auto free = std::ranges::find(meshes_, false, &Parts::is_used);
    const auto at = free - meshes_.begin();
    if (free == meshes_.end()) meshes_.emplace_back();
    meshes_[static_cast<std::size_t>(at)].is_used = true;
    return static_cast<Mesh>(at);
}

MeshPool::Mesh MeshPool::make(const geometry::SurfaceGrid& grid) {
    const Mesh mesh = make();
    meshes_[static_cast<std::size_t>(mesh)].grid = grid;
    return mesh;
}

void MeshPool::remove(Mesh mesh) {
    ++changes_;
    Parts& parts = meshes_[static_cast<std::size_t>(mesh)];
    for (const auto& [number, part] : parts.of) give_back(part);
    parts = Parts{};
}

void MeshPool::give_back(const Part& part) {
    for (const Place& place : part.levels) {
        if (place.indices == 0) continue;
        vertex_shelf_.give_back(place.first_vertex, place.vertices);
        index_shelf_.give_back(place.first_index, place.indices);
    }
}

MeshPool::Place MeshPool::put(const geometry::SurfacePatch& patch) {
    if (patch.triangles.empty()) return {};
    const Place place{vertex_shelf_.take(patch.vertices.size()), patch.vertices.size(),
                      index_shelf_.take(patch.triangles.size()), patch.triangles.size()};
    ensure(vertex_buffer_, vertex_bytes_, vertex_shelf_.end() * sizeof(geometry::SurfaceVertex));
    ensure(index_buffer_, index_bytes_, index_shelf_.end() * sizeof(std::uint32_t));
    const auto send = [](GLuint buffer, std::size_t first, const auto& values) {
        const std::size_t size = sizeof values.front();
        glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
        glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(first * size),
                        static_cast<GLsizeiptr>(values.size() * size), values.data());
    };
    send(vertex_buffer_, place.first_vertex, patch.vertices);
    send(index_buffer_, place.first_index, patch.triangles);
    return place;
}

/// In full detail; null: the part is empty.
MeshPool::Part* MeshPool::replace_part(Mesh mesh, std::uint32_t number, const geometry::SurfacePatch& patch) {
    if (std::ranges::any_of(patch.triangles, [&](std::uint32_t v) { return v >= patch.vertices.size(); }))
        throw Error("a mesh refers to a vertex that does not exist");
    Parts& parts = meshes_[static_cast<std::size_t>(mesh)];
    const auto known = parts.of.find(number);
    if (known == parts.of.end() && patch.triangles.empty()) return nullptr;
    ++changes_;
    if (known != parts.of.end()) {
        give_back(known->second);
        parts.of.erase(known);
    }
    if (patch.triangles.empty()) return nullptr;
    Part& part = parts.of[number];
    part.bounds = bounds_of(patch);
    part.levels[0] = put(patch);
    return &part;
}

void MeshPool::put_levels(Part& part, const geometry::CoarseSurface::Levels& coarse) {
    for (std::size_t level = 0; level < coarse.size(); ++level) part.levels[level + 1] = put(coarse[level]);
}

void MeshPool::set_part(Mesh mesh, std::uint32_t number, const geometry::SurfacePatch& patch) {
    Part* const part = replace_part(mesh, number, patch);
    const auto& grid = meshes_[static_cast<std::size_t>(mesh)].grid;
    if (part && grid) put_levels(*part, coarse_.make(patch, *grid));
}

void MeshPool::set_part(Mesh mesh, std::uint32_t number, const geometry::SurfacePatch& patch,
                        const geometry::CoarseSurface::Levels& coarse) {
    if (Part* const part = replace_part(mesh, number, patch)) put_levels(*part, coarse);
}

std::size_t MeshPool::triangles(Mesh mesh) const {
    std::size_t count = 0;
    for (const auto& [number, part] : meshes_[static_cast<std::size_t>(mesh)].of) count += part.levels[0].indices / 3;
    return count;
}

/// All parts use the same level of detail, so that they match at their borders.
std::size_t MeshPool::level_for(const Parts& parts, const Mat4& to_clip, int width, int height, double grain) const {
    if (!parts.grid || !(grain > 0.0)) return 0;
    const auto row = [&](int n) { return Vec3(to_clip[0][n], to_clip[1][n], to_clip[2][n]); };
    const Vec3 depth = row(3);
    double nearest = 1e30;
    for (const Part* part : seen_) {
        double at = to_clip[3][3];
        for (int axis = 0; axis < 3; ++axis)
            at += depth[axis] * (depth[axis] > 0.0 ? part->bounds.low[axis] : part->bounds.high[axis]);
        nearest = std::min(nearest, at);
    }
    const double pixels_per_m =
        0.5 * std::max(width * glm::length(row(0)), height * glm::length(row(1))) / std::max(nearest, 1e-9);
    const Vec3& voxel = parts.grid->voxel;
    const double voxel_pixels = std::max({voxel.x, voxel.y, voxel.z}) * pixels_per_m;
    std::size_t level = 0;
    while (level < geometry::CoarseSurface::factors.size() &&
           geometry::CoarseSurface::factors[level] * voxel_pixels <= grain)
        ++level;
    return level;
}

std::size_t MeshPool::draw(Mesh mesh, const Mat4& to_clip, int width, int height, double grain,
                           TriangleSpan span) const {
    const Parts& parts = meshes_[static_cast<std::size_t>(mesh)];
    const Frustum frustum(to_clip);
    seen_.clear();
    for (const auto& [number, part] : parts.of)
        if (frustum.meets(part.bounds)) seen_.push_back(&part);
    const std::size_t level = level_for(parts, to_clip, width, height, grain);
    counts_.clear();
    bases_.clear();
    offsets_.clear();
    std::size_t drawn = 0;
    for (const Part* part : seen_) {
        const Place& place = part->levels[level];
        const std::size_t all = place.indices / 3, left_out = std::min(all, span.first);
        const std::size_t count = std::min(all - left_out, span.most - drawn);
        span.first -= left_out;
        if (count == 0) continue;
        counts_.push_back(static_cast<std::int32_t>(3 * count));
        bases_.push_back(static_cast<std::int32_t>(place.first_vertex));
        offsets_.push_back(reinterpret_cast<const void*>((place.first_index + 3 * left_out) * sizeof(std::uint32_t)));
        drawn += count;
    }
    if (counts_.empty()) return 0;
    glBindVertexArray(array_);
    glMultiDrawElementsBaseVertex(GL_TRIANGLES, counts_.data(), GL_UNSIGNED_INT, offsets_.data(),
                                  static_cast<GLsizei>(counts_.size()), bases_.data());
    return drawn;
}

}  // namespace tactus::display
