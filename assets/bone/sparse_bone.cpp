// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/sparse_bone.hpp"

#include "assets/bone/from_hu.hpp"
#include "assets/mesh/mesh.hpp"
#include "dsp/core/stop.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace tactus::bone {

namespace {

constexpr int side = SparseBone::side;

std::size_t sample_index(int x, int y, int z) { return static_cast<std::size_t>((z * side + y) * side + x); }

// The dense grid of one quantity, which `values` selects in a block; `elsewhere` where no block is stored.
template <typename Values>
volume::Grid dense(const SparseBone& sparse, float elsewhere, Values values) {
    volume::Grid grid = sparse.layout;
    grid.values.assign(grid.count(), elsewhere);
    const auto [nx, ny, nz] = sparse.blocks_per_axis();
    const auto& size = grid.size;
    for (int bz = 0; bz < nz; ++bz)
        for (int by = 0; by < ny; ++by) {
            leave_if_stopped();
            for (int bx = 0; bx < nx; ++bx) {
                const SparseBone::Block* block = sparse.blocks[sparse.block_index(bx, by, bz)].get();
                if (!block) continue;
                const int width = std::min(side, size[0] - bx * side);
                for (int z = bz * side; z < std::min(bz * side + side, size[2]); ++z)
                    for (int y = by * side; y < std::min(by * side + side, size[1]); ++y)
                        std::copy_n(values(*block) + sample_index(0, y - by * side, z - bz * side), width,
                                    &grid.values[grid.index(bx * side, y, z)]);
            }
        }
    return grid;
}

}  // namespace

SparseBone::SparseBone(volume::Grid size_and_place, float outside_of_blocks)
    : layout(std::move(size_and_place)), outside(outside_of_blocks) {
    layout.values.clear();
    const auto [x, y, z] = blocks_per_axis();
    blocks.resize(static_cast<std::size_t>(x) * static_cast<std::size_t>(y) * static_cast<std::size_t>(z));
}

std::size_t SparseBone::stored() const {
    return static_cast<std::size_t>(
        std::count_if(blocks.begin(), blocks.end(), [](const auto& b) { return b != nullptr; }));
}

void SparseBone::add_layers(int first, const volume::Grid& distance, const volume::Grid& density, const RunJobs& run) {
    const auto [nx, ny, nz] = blocks_per_axis();
    const int begin = first / side, end = (first + distance.size[2] + side - 1) / side;
    run((end - begin) * ny, [&](int job) {
        const int bz = begin + job / ny, by = job % ny;
        const int z0 = bz * side - first, z1 = std::min(z0 + side, distance.size[2]);
        const int y0 = by * side, y1 = std::min(y0 + side, layout.size[1]);
        for (int bx = 0; bx < nx; ++bx) {
            const int x0 = bx * side, x1 = std::min(x0 + side, layout.size[0]);
            const auto any_near = [&] {
                for (int z = z0; z < z1; ++z)
                    for (int y = y0; y < y1; ++y) {
                        const float* row = &distance.values[distance.index(x0, y, z)];
                        if (std::any_of(row, row + (x1 - x0), [&](float d) { return d < outside; })) return true;
                    }
                return false;
            };
            if (!any_near()) continue;
            auto block = std::make_unique<Block>();
            block->distance.fill(outside);
            block->density.fill(0.0f);
            for (int z = z0; z < z1; ++z)
                for (int y = y0; y < y1; ++y) {
                    const std::size_t to = sample_index(0, y - y0, z - z0), from = distance.index(x0, y, z);
                    std::copy_n(&distance.values[from], x1 - x0, &block->distance[to]);
                    std::copy_n(&density.values[from], x1 - x0, &block->density[to]);
                }
            blocks[block_index(bx, by, bz)] = std::move(block);
        }
    });
}

void SparseBone::copy_distance(const std::array<int, 3>& low, volume::Grid& into) const {
    for (int k = 0; k < into.size[2]; ++k)
        for (int j = 0; j < into.size[1]; ++j)
            for (int i = 0; i < into.size[0]; ++i) {
                const int x = std::min(low[0] + i, layout.size[0] - 1), y = std::min(low[1] + j, layout.size[1] - 1),
                          z = std::min(low[2] + k, layout.size[2] - 1);
                const Block* block = blocks[block_index(x / side, y / side, z / side)].get();
                into.at(i, j, k) = block ? block->distance[sample_index(x % side, y % side, z % side)] : outside;
            }
}

volume::Grid dense_distance_of(const SparseBone& sparse) {
    return dense(sparse, sparse.outside, [](const SparseBone::Block& block) { return block.distance.data(); });
}

Bone dense_of(const SparseBone& sparse) {
    Bone bone;
    bone.distance = dense_distance_of(sparse);
    bone.density = dense(sparse, 0.0f, [](const SparseBone::Block& block) { return block.density.data(); });
    return bone;
}

BoneMeasures measures_of(const SparseBone& bone, const RunJobs& run) {
    const auto [nx, ny, nz] = bone.blocks_per_axis();
    std::vector<BoneMeasures> parts(static_cast<std::size_t>(nz) * static_cast<std::size_t>(ny));
    const auto& size = bone.layout.size;
    run(nz * ny, [&](int job) {
        BoneMeasures& part = parts[static_cast<std::size_t>(job)];
        part.least = std::numeric_limits<double>::infinity();
        const int bz = job / ny, by = job % ny;
        for (int bx = 0; bx < nx; ++bx) {
            const SparseBone::Block* block = bone.blocks[bone.block_index(bx, by, bz)].get();
            if (!block) continue;
            const std::array<int, 3> low{bx * side, by * side, bz * side};
            volume::Grid cells{{}, bone.layout.position(low[0], low[1], low[2]), bone.layout.spacing, {}};
            for (std::size_t a = 0; a < 3; ++a) cells.size[a] = std::min(side + 1, size[a] - low[a]);
            cells.values.resize(cells.count());
            bone.copy_distance(low, cells);
            for (int z = 0; z < std::min(side, cells.size[2]); ++z)
                for (int y = 0; y < std::min(side, cells.size[1]); ++y)
                    for (int x = 0; x < std::min(side, cells.size[0]); ++x) {
                        if (!(cells.at(x, y, z) < 0.0f)) continue;
                        const double density = block->density[sample_index(x, y, z)];
                        if (density > max_bone_density) {
                            ++part.metal;
                            continue;
                        }
                        part.mean += density;
                        part.least = std::min(part.least, density);
                        part.most = std::max(part.most, density);
                        ++part.inside;
                    }
            const geometry::TriangleSurface surface = geometry::iso_surface(cells, 0.0f, false);
            for (const auto& t : surface.triangles) {
                const auto at = [&](std::size_t c) {
                    return surface.vertices[static_cast<std::size_t>(t[c])] - bone.layout.origin;
                };
                part.volume += glm::dot(at(0), glm::cross(at(1), at(2))) / 6.0;
            }
            part.area += mesh::area_of(surface);
        }
    });
    BoneMeasures all;
    all.least = std::numeric_limits<double>::infinity();
    for (const BoneMeasures& part : parts) {
        all.volume += part.volume;
        all.area += part.area;
        all.mean += part.mean;
        all.least = std::min(all.least, part.least);
        all.most = std::max(all.most, part.most);
        all.inside += part.inside;
        all.metal += part.metal;
    }
    if (all.inside > 0) all.mean /= static_cast<double>(all.inside);
    else all.least = all.most = all.mean = all.metal > 0 ? max_bone_density : 0.0;
    return all;
}

}  // namespace tactus::bone
