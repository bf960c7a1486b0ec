// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/scan.hpp"
#include "dsp/core/error.hpp"

#include <algorithm>

namespace tactus::vessel {

Scan::Scan(const volume::Grid& grid)
    : grid_(grid),
      per_metre_(1.0 / grid.spacing.x, 1.0 / grid.spacing.y, 1.0 / grid.spacing.z),
      voxel_(std::cbrt(grid.spacing.x * grid.spacing.y * grid.spacing.z)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] < 2) throw Error("the scan needs at least two samples along each axis");
        blocks_[axis] = (grid.size[axis] + side - 1) / side;
    }
}

void Scan::exclude_above(double value) {
    limit_ = value;
    excluded_.clear();
    if (std::isfinite(limit_))
        excluded_.resize(static_cast<std::size_t>(blocks_[0]) * static_cast<std::size_t>(blocks_[1]) *
                         static_cast<std::size_t>(blocks_[2]));
}

bool Scan::contains(const Vec3& position) const { return inside_by(position) >= 0.0; }

double Scan::inside_by(const Vec3& position) const {
    const Vec3 low = position - grid_.origin;
    const Vec3 high = grid_.position(grid_.size[0] - 1, grid_.size[1] - 1, grid_.size[2] - 1) - position;
    return std::min({low.x, low.y, low.z, high.x, high.y, high.z});
}

bool Scan::is_core(int i, int j, int k) const {
    if (!(double(grid_.at(i, j, k)) > limit_)) return false;
    int above = 0;
    for (int z = std::max(0, k - 1); z <= std::min(grid_.size[2] - 1, k + 1); ++z)
        for (int y = std::max(0, j - 1); y <= std::min(grid_.size[1] - 1, j + 1); ++y)
            for (int x = std::max(0, i - 1); x <= std::min(grid_.size[0] - 1, i + 1); ++x)
                above += double(grid_.at(x, y, z)) > limit_;
    return above >= 3;
}

const Scan::Block& Scan::block(std::size_t index, int i, int j, int k) const {
    std::unique_ptr<Block>& found = excluded_[index];
    if (found) return *found;
    found = std::make_unique<Block>();
    found->fill(0);
    const int low[3] = {i / side * side, j / side * side, k / side * side};
    constexpr int reach = 2;
    for (int z = low[2] - reach; z < low[2] + side + reach; ++z)
        for (int y = low[1] - reach; y < low[1] + side + reach; ++y)
            for (int x = low[0] - reach; x < low[0] + side + reach; ++x) {
                if (x < 0 || y < 0 || z < 0 || x >= grid_.size[0] || y >= grid_.size[1] || z >= grid_.size[2] ||
                    !is_core(x, y, z))
                    continue;
                for (int dz = -reach; dz <= reach; ++dz)
                    for (int dy = -reach; dy <= reach; ++dy)
                        for (int dx = -reach; dx <= reach; ++dx) {
                            const int a = x + dx - low[0], b = y + dy - low[1], c = z + dz - low[2];
                            if (dx * dx + dy * dy + dz * dz > reach * reach || a < 0 || b < 0 || c < 0 || a >= side ||
                                b >= side || c >= side)
                                continue;
                            (*found)[static_cast<std::size_t>((c * side + b) * side + a)] = 1;
                        }
            }
    return *found;
}

bool Scan::is_excluded(int i, int j, int k) const {
    if (excluded_.empty()) return false;
    const std::size_t index = (static_cast<std::size_t>(k / side) * static_cast<std::size_t>(blocks_[1]) +
                               static_cast<std::size_t>(j / side)) *
                                  static_cast<std::size_t>(blocks_[0]) +
                              static_cast<std::size_t>(i / side);
    return block(index, i, j, k)[static_cast<std::size_t>((k % side * side + j % side) * side + i % side)] != 0;
}

bool Scan::is_excluded(const Vec3& position) const {
    if (!contains(position)) return false;
    const Vec3 at = index_of(position) + 0.5;
    return is_excluded(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z));
}

namespace {

float trilinear(const volume::Grid& grid, const Vec3& at) {
    const int i = std::min(static_cast<int>(at.x), grid.size[0] - 2),
              j = std::min(static_cast<int>(at.y), grid.size[1] - 2),
              k = std::min(static_cast<int>(at.z), grid.size[2] - 2);
    const float x = static_cast<float>(at.x - i), y = static_cast<float>(at.y - j), z = static_cast<float>(at.z - k);
    const float* const p = grid.values.data() + grid.index(i, j, k);
    const std::size_t row = static_cast<std::size_t>(grid.size[0]),
                      layer = row * static_cast<std::size_t>(grid.size[1]);
    const auto along_x = [&](const float* q) { return q[0] + x * (q[1] - q[0]); };
    const float low = along_x(p) + y * (along_x(p + row) - along_x(p));
    const float high = along_x(p + layer) + y * (along_x(p + layer + row) - along_x(p + layer));
    return low + z * (high - low);
}

}  // namespace

bool Scan::value(const Vec3& position, float& out) const {
    const Vec3 at = index_of(position);
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.z >= 0.0 && at.x <= grid_.size[0] - 1 && at.y <= grid_.size[1] - 1 &&
          at.z <= grid_.size[2] - 1))
        return false;
    if (!excluded_.empty() &&
        is_excluded(static_cast<int>(at.x + 0.5), static_cast<int>(at.y + 0.5), static_cast<int>(at.z + 0.5)))
        return false;
    out = std::max(least_, trilinear(grid_, at));
    return true;
}

double Scan::any_value(const Vec3& position) const {
    Vec3 at = index_of(position);
    for (int axis = 0; axis < 3; ++axis)
        at[axis] = std::clamp(at[axis], 0.0, double(grid_.size[static_cast<std::size_t>(axis)] - 1));
    return double(trilinear(grid_, at));
}

double Scan::blur_variance(const Vec3& direction, double psf_voxels) const {
    const Vec3 along = direction * grid_.spacing;
    return (along.x * along.x + along.y * along.y + along.z * along.z) * (psf_voxels * psf_voxels + 1.0 / 6.0);
}

}  // namespace tactus::vessel
