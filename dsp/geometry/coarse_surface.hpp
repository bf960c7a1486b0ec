// SPDX-License-Identifier: Apache-2.0
// Simplifies a surface by vertex clustering (Rossignac and Borrel 1993), for images in which a triangle of the full
// surface covers about a pixel. Vertices in one cell of a grid are merged unless that would change the outline.
#pragma once

#include "dsp/geometry/brick_surface.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus::geometry {

/// The grid from which a surface was made.
struct SurfaceGrid {
    Vec3 origin{0.0};  ///< a corner between parts, m
    Vec3 voxel{1e-3};  ///< m
    int part = 0;  ///< voxels along the side of a part, such as a brick; 0: the surface is one part
};

/// Keeps its working memory. Not thread-safe.
class CoarseSurface {
public:
    /// Voxels along the side of a cell, by level; cells of a level nest in those of the next. All divide a part.
    static constexpr std::array<int, 4> factors{1, 2, 4, 8};
    using Levels = std::array<SurfacePatch, factors.size()>;

    /// The simplified surface of each level; valid until the next call. A merged vertex stays within its cell and
    /// within a quarter of the cell's side of the surface; every remaining vertex is a vertex of `fine`. Several parts
    /// that form a closed body remain closed: vertices on the face between two parts stay there, and both parts keep
    /// the same ones.
    const Levels& make(const SurfacePatch& fine, const SurfaceGrid& grid);

private:
    struct Cell {
        std::uint64_t key = 0;
        double distance = 0.0;  ///< of its vertex to its middle, squared, in cells
        std::uint32_t vertex = 0;
    };

    void merge(const SurfacePatch& fine, const SurfaceGrid& grid, int factor, SurfacePatch& coarse);
    std::uint32_t cell_of(std::uint64_t key);

    Levels levels_;
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> slots_;  // open addressing: number in cells_ plus one
    std::vector<std::uint32_t> now_;  // cell by vertex of the finer one
};

}  // namespace tactus::geometry
