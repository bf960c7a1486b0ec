// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/bricks.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/large_pages.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/volume/interpolation.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstring>
#include <utility>

namespace tactus::volume {

namespace {

/// The cell that contains a position, the position within it, and its low-corner sample, or null where none is stored.
struct BrickCell : GridCell {
    const float* corner = nullptr;

    Trilinear trilinear() const noexcept { return {corner, brick_side, brick_side * brick_side}; }
};

BrickCell find_cell(const BrickLayout& layout, const std::vector<const float*>& table, const Vec3& position) noexcept {
    const GridCell cell = find_grid_cell(layout.origin, layout.spacing, layout.size, position);
    if (!cell.inside) return {};
    const auto [i, j, k] = std::array{cell.i, cell.j, cell.k};
    const float* brick = table[static_cast<std::size_t>(layout.brick_index(i >> 3, j >> 3, k >> 3))];
    return {cell, brick ? brick + BrickLayout::sample_index(i & 7, j & 7, k & 7) : nullptr};
}

/// Beyond the border of the grid: the distance there and the way to it, as if the nearest surface lay straight inwards. Bone
/// that the border cuts ends there.
Sample beyond(const BoneSnapshot& bone, const Vec3& position) noexcept {
    const BrickLayout& grid = *bone.root->layout;
    const Vec3 last = Vec3(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1) * (1.0 - 1e-9) * grid.spacing;
    const Vec3 border = grid.origin + glm::clamp(position - grid.origin, Vec3(0.0), last);
    const Vec3 way = position - border;
    const double length = glm::length(way);
    const Sample none{grid.far, Vec3(0.0), false};
    if (!(length > 0.0 && length < grid.far)) return none;
    const BrickCell cell = find_cell(grid, bone.root->distance, border);
    if (!cell.corner) return none;
    const Interpolated at = cell.trilinear()(cell);
    Sample found{std::max(at.value, 0.0) + length, at.slope / grid.spacing, true};
    if (!(found.value < grid.far)) return none;
    for (int axis = 0; axis < 3; ++axis)
        if (way[axis] != 0.0) found.gradient[axis] = way[axis] / length;
    return found;
}

}  // namespace

// Without samples every position is outside.
static constexpr BrickLayout empty_layout{.far = 1.0};
const BoneRoot empty_bone{&empty_layout, {}, {}};

Sample BoneSnapshot::sample(const Vec3& position) const noexcept {
    const BrickLayout& grid = *root->layout;
    const BrickCell cell = find_cell(grid, root->distance, position);
    if (!cell.corner) return cell.inside ? Sample{grid.far, Vec3(0.0), false} : beyond(*this, position);
    const Interpolated at = cell.trilinear()(cell);
    return {at.value, at.slope / grid.spacing, true};
}

Sample BoneSnapshot::smooth_sample(const Vec3& position) const noexcept {
    const BrickLayout& grid = *root->layout;
    if (!find_cell(grid, root->distance, position).corner) return {grid.far, Vec3(0.0), false};
    const QuadraticSpline spline(grid.origin, grid.spacing, grid.size, position);
    // Per axis: brick of the three samples and their index within it.
    int brick[3][3], within[3][3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (int n = 0; n < 3; ++n) {
            const int index = spline.index[axis][n];
            brick[axis][n] = std::min(index >> 3, grid.bricks[axis] - 1);
            within[axis][n] = index - 8 * brick[axis][n];
        }
    const Interpolated at = spline([&](int i, int j, int k) {
        const auto b = static_cast<std::size_t>(grid.brick_index(brick[0][i], brick[1][j], brick[2][k]));
        const float* samples = root->distance[b];
        if (!samples) return grid.far;
        return static_cast<double>(samples[BrickLayout::sample_index(within[0][i], within[1][j], within[2][k])]);
    });
    return {at.value, at.slope / grid.spacing, true};
}

double BoneSnapshot::value(const Vec3& position) const noexcept {
    const BrickCell cell = find_cell(*root->layout, root->distance, position);
    if (cell.corner) return cell.trilinear().value(cell);
    return cell.inside ? root->layout->far : beyond(*this, position).value;
}

double BoneSnapshot::density(const Vec3& position) const noexcept {
    const BrickCell cell = find_cell(*root->layout, root->density, position);
    return cell.corner ? cell.trilinear().value(cell) : 0.0;
}

BoneEditor::BoneEditor(const Grid& distance, const Grid& density, const BoneEditorOptions& options)
    : options_(options) {
    if (distance.size != density.size || distance.values.size() != distance.count() ||
        density.values.size() != density.count())
        throw Error("a bone's distance and density need grids of one size");
    for (const int n : distance.size)
        if (n < 2) throw Error("a bone needs at least two samples along each axis");
    layout_.size = distance.size;
    layout_.origin = distance.origin;
    layout_.spacing = distance.spacing;
    layout_.far = options.band;
    for (std::size_t axis = 0; axis < 3; ++axis)
        layout_.bricks[axis] = (distance.size[axis] - 1 + brick_cells - 1) / brick_cells;

    const auto count = static_cast<std::size_t>(layout_.brick_count());
    const auto gather = [this](const Grid& grid, std::size_t brick, float* into) {
        const int bx = static_cast<int>(brick) % layout_.bricks[0];
        const int by = static_cast<int>(brick) / layout_.bricks[0] % layout_.bricks[1];
        const int bz = static_cast<int>(brick) / layout_.bricks[0] / layout_.bricks[1];
        for (int z = 0; z < brick_side; ++z)
            for (int y = 0; y < brick_side; ++y)
                for (int x = 0; x < brick_side; ++x)
                    into[BrickLayout::sample_index(x, y, z)] =
                        grid.at(std::min(8 * bx + x, grid.size[0] - 1), std::min(8 * by + y, grid.size[1] - 1),
                                std::min(8 * bz + z, grid.size[2] - 1));
    };
    std::vector<std::uint8_t> stored(count);
    std::size_t needed = 0;
    std::array<float, brick_samples> brick;
    for (std::size_t b = 0; b < count; ++b) {
        if (b % 4096 == 0) leave_if_stopped();
        gather(distance, b, brick.data());
        stored[b] = std::ranges::any_of(brick, [&](float d) { return static_cast<double>(d) < options.band; });
        needed += stored[b];
    }
    const std::size_t extra =
        needed + static_cast<std::size_t>(options.max_versions) * static_cast<std::size_t>(options.max_dirty);
    const std::size_t samples = (2 * needed + extra) * brick_samples;
    storage_ = std::make_unique_for_overwrite<float[]>(samples);
    prefer_large_pages(storage_.get(), samples * sizeof(float));
    std::fill_n(storage_.get(), samples, 0.0f);  // also so that no tick touches a page first
    float* next = storage_.get();
    const auto take = [&next] { return std::exchange(next, next + brick_samples); };
    working_.layout = &layout_;
    working_.distance.resize(count);
    working_.density.resize(count);
    for (std::size_t b = 0; b < count; ++b) {
        if (!stored[b]) continue;
        float* d = take();
        gather(distance, b, d);
        working_.distance[b] = d;
        float* rho = take();
        gather(density, b, rho);
        working_.density[b] = rho;
    }
    free_.reserve(extra + needed);
    for (std::size_t i = 0; i < extra; ++i) free_.push_back(take());
    // A consumer may hold one publication while max_versions others are in the queue.
    for (int i = 0; i < options.max_versions + 2; ++i) {
        roots_.push_back(std::make_unique<BoneRoot>(working_));
        free_roots_.push_back(roots_.back().get());
    }
    born_.assign(count, 1);
    is_dirty_.assign(count, 0);
    dirty_.reserve(static_cast<std::size_t>(options.max_dirty));
    changed_.reserve(static_cast<std::size_t>(options.max_dirty));
    retired_.reserve(extra + needed);
    readable_.reserve(static_cast<std::size_t>(options.max_versions) + 2);
    BoneRoot* first = free_roots_.back();
    free_roots_.pop_back();
    readable_.push_back({version_, first});
    current_ = {first, version_, hash_.value()};
}

float BoneEditor::get(int i, int j, int k) const noexcept {
    // The last plane of samples is the ninth of the last brick.
    const int bx = std::min(i >> 3, layout_.bricks[0] - 1), by = std::min(j >> 3, layout_.bricks[1] - 1),
              bz = std::min(k >> 3, layout_.bricks[2] - 1);
    const float* brick = working_.distance[static_cast<std::size_t>(layout_.brick_index(bx, by, bz))];
    return brick ? brick[BrickLayout::sample_index(i - 8 * bx, j - 8 * by, k - 8 * bz)]
                 : static_cast<float>(layout_.far);
}

float* BoneEditor::writable(int brick) noexcept {
    const auto b = static_cast<std::size_t>(brick);
    // The editor owns every brick; the table is const for readers only.
    auto* present = const_cast<float*>(working_.distance[b]);
    if (is_dirty_[b]) return present;
    float* copy = free_.back();
    free_.pop_back();
    std::memcpy(copy, present, brick_samples * sizeof(float));
    retired_.push_back({present, born_[b], version_ + 1});
    working_.distance[b] = copy;
    born_[b] = version_ + 1;
    is_dirty_[b] = 1;
    dirty_.push_back(static_cast<std::uint32_t>(brick));
    return copy;
}

bool BoneEditor::set(int i, int j, int k, float value) noexcept {
    if (i < 0 || j < 0 || k < 0 || i >= layout_.size[0] || j >= layout_.size[1] || k >= layout_.size[2]) return false;
    std::array<int, 8> bricks;
    int count = 0, fresh = 0;
    for (int bz = std::max(0, (k - 1) >> 3); bz <= std::min(k >> 3, layout_.bricks[2] - 1); ++bz)
        for (int by = std::max(0, (j - 1) >> 3); by <= std::min(j >> 3, layout_.bricks[1] - 1); ++by)
            for (int bx = std::max(0, (i - 1) >> 3); bx <= std::min(i >> 3, layout_.bricks[0] - 1); ++bx) {
                const int brick = layout_.brick_index(bx, by, bz);
                if (!working_.distance[static_cast<std::size_t>(brick)]) continue;
                fresh += !is_dirty_[static_cast<std::size_t>(brick)];
                bricks[static_cast<std::size_t>(count++)] = brick;
            }
    if (count == 0 || fresh > dirty_left() || fresh > static_cast<int>(free_.size())) return false;
    for (int n = 0; n < count; ++n) {
        const int brick = bricks[static_cast<std::size_t>(n)];
        const int bx = brick % layout_.bricks[0], by = brick / layout_.bricks[0] % layout_.bricks[1],
                  bz = brick / layout_.bricks[0] / layout_.bricks[1];
        writable(brick)[BrickLayout::sample_index(i - 8 * bx, j - 8 * by, k - 8 * bz)] = value;
    }
    return true;
}

BoneSnapshot BoneEditor::publish() noexcept {
    // Without room for another version, the edits wait for the next publication.
    if (dirty_.empty() || free_roots_.empty()) {
        if (dirty_.empty()) changed_.clear();
        return current_;
    }
    ++version_;
    std::ranges::sort(dirty_);
    for (const std::uint32_t brick : dirty_) {
        hash_.add_word(brick);
        hash_.add_bytes(working_.distance[brick], brick_samples * sizeof(float));
        is_dirty_[brick] = 0;
    }
    changed_.swap(dirty_);
    dirty_.clear();
    BoneRoot* root = free_roots_.back();
    free_roots_.pop_back();
    std::ranges::copy(working_.distance, root->distance.begin());
    readable_.push_back({version_, root});
    current_ = {root, version_, hash_.value()};
    return current_;
}

void BoneEditor::release_unreadable() noexcept {
    std::erase_if(retired_, [this](const Retired& old) {
        const auto first = std::ranges::lower_bound(readable_, old.first, {}, &Published::version);
        if (first != readable_.end() && first->version < old.end) return false;
        free_.push_back(old.brick);
        return true;
    });
}

void BoneEditor::reclaim(std::int64_t oldest_readable) noexcept {
    const std::size_t before = readable_.size();
    std::erase_if(readable_, [&](const Published& old) {
        if (old.version >= oldest_readable || old.version == version_) return false;
        free_roots_.push_back(old.root);
        return true;
    });
    if (readable_.size() != before) release_unreadable();
}

void BoneEditor::forget(std::int64_t version) noexcept {
    const auto found = std::ranges::find(readable_, version, &Published::version);
    if (found == readable_.end() || version == version_) return;
    free_roots_.push_back(found->root);
    readable_.erase(found);
    release_unreadable();
}

Grid to_grid(const BoneSnapshot& bone) {
    const BrickLayout& layout = bone.layout();
    Grid grid{layout.size, layout.origin, layout.spacing, {}};
    grid.values.resize(grid.count());
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const int bx = std::min(i >> 3, layout.bricks[0] - 1), by = std::min(j >> 3, layout.bricks[1] - 1),
                          bz = std::min(k >> 3, layout.bricks[2] - 1);
                const float* brick = bone.root->distance[static_cast<std::size_t>(layout.brick_index(bx, by, bz))];
                grid.at(i, j, k) = brick ? brick[BrickLayout::sample_index(i - 8 * bx, j - 8 * by, k - 8 * bz)]
                                         : static_cast<float>(layout.far);
            }
    return grid;
}

}  // namespace tactus::volume
