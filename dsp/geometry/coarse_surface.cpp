// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/coarse_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::geometry {

namespace {

// In voxels: a vertex this close to a face between two parts lies on it. Far from the origin, single precision adds an
// error of up to half of this share of the coordinate.
constexpr double on_face = 2e-4, precision = 0x1p-23;
// The vertex nearest to this point is kept. Not exactly the middle, from which vertices of a regular surface are
// equally far: the choice must not depend on the order of vertices, which differs between parts.
constexpr std::array middle{0.47, 0.52, 0.44};

// In cell sides: how far a vertex may move off the surface. Levels add up to twice this.
constexpr double max_off = 0.12;

Vec3 position(const SurfaceVertex& v) {
    return {static_cast<double>(v.position[0]), static_cast<double>(v.position[1]), static_cast<double>(v.position[2])};
}

/// How far `b` lies off the plane through `a`, or `a` off the plane through `b`: the change of the outline when one
/// vertex moves to the other. Motion within the surface does not change it.
double off_surface(const SurfaceVertex& a, const SurfaceVertex& b) {
    const Vec3 way = position(b) - position(a);
    const auto along = [&](const SurfaceVertex& v) {
        return std::abs(way.x * v.normal[0] + way.y * v.normal[1] + way.z * v.normal[2]) / 32767.0;
    };
    return std::max(along(a), along(b));
}

}  // namespace

std::uint32_t CoarseSurface::cell_of(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (key * 0x9E3779B97F4A7C15u >> 32) & mask;
    for (; slots_[at] != 0; at = (at + 1) & mask)
        if (cells_[slots_[at] - 1].key == key) return slots_[at] - 1;
    cells_.push_back({key, 1e30, 0});
    slots_[at] = static_cast<std::uint32_t>(cells_.size());
    return slots_[at] - 1;
}

const CoarseSurface::Levels& CoarseSurface::make(const SurfacePatch& fine, const SurfaceGrid& grid) {
    const SurfacePatch* finer = &fine;
    for (std::size_t level = 0; level < factors.size(); ++level) {
        merge(*finer, grid, factors[level], levels_[level]);
        finer = &levels_[level];
    }
    return levels_;
}

void CoarseSurface::merge(const SurfacePatch& fine, const SurfaceGrid& grid, int factor, SurfacePatch& coarse) {
    coarse.vertices.clear();
    coarse.triangles.clear();
    cells_.clear();
    slots_.assign(std::bit_ceil(2 * fine.vertices.size() + 2), 0);
    now_.resize(fine.vertices.size());
    const Vec3 per_cell = 1.0 / (grid.voxel * static_cast<double>(factor));
    // Cells are counted from far below zero, so that truncation always rounds down.
    constexpr std::int64_t lowest = 1 << 19;
    const std::int64_t cells_per_part = grid.part / factor;
    const double part_per_cell = cells_per_part > 0 ? 1.0 / static_cast<double>(cells_per_part) : 0.0;
    for (std::size_t v = 0; v < fine.vertices.size(); ++v) {
        std::uint64_t key = 0;
        double distance = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto i = static_cast<std::size_t>(axis);
            const double along = static_cast<double>(fine.vertices[v].position[i]);
            const double at = static_cast<double>(lowest) + (along - grid.origin[axis]) * per_cell[axis];
            const double near = std::max(on_face / factor, precision * std::abs(along) * per_cell[axis]);
            const std::int64_t face = cells_per_part * static_cast<std::int64_t>(at * part_per_cell + 0.5);
            const bool is_on_face = grid.part > 0 && std::abs(at - static_cast<double>(face)) < near;
            const std::int64_t cell = is_on_face ? face : static_cast<std::int64_t>(at);
            const double off = is_on_face ? 0.0 : at - static_cast<double>(cell) - middle[i];
            distance += off * off;
            key = key << 21 | (static_cast<std::uint64_t>(2 * cell + (is_on_face ? 1 : 0)) & 0x1fffff);
        }
        now_[v] = cell_of(key);
        Cell& cell = cells_[now_[v]];
        if (distance >= cell.distance) continue;
        cell.distance = distance;
        cell.vertex = static_cast<std::uint32_t>(v);
    }
    const double may_move = max_off * factor * std::min({grid.voxel.x, grid.voxel.y, grid.voxel.z});
    for (std::size_t v = 0; v < fine.vertices.size(); ++v) {
        if (!(off_surface(fine.vertices[v], fine.vertices[cells_[now_[v]].vertex]) > may_move)) continue;
        now_[v] = static_cast<std::uint32_t>(cells_.size());
        cells_.push_back({0, 0.0, static_cast<std::uint32_t>(v)});
    }
    for (const Cell& cell : cells_) coarse.vertices.push_back(fine.vertices[cell.vertex]);
    for (std::size_t t = 0; t + 2 < fine.triangles.size(); t += 3) {
        const std::array corners{now_[fine.triangles[t]], now_[fine.triangles[t + 1]], now_[fine.triangles[t + 2]]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
        coarse.triangles.insert(coarse.triangles.end(), corners.begin(), corners.end());
    }
}

}  // namespace tactus::geometry
