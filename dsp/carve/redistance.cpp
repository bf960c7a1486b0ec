// SPDX-License-Identifier: Apache-2.0
#include "dsp/carve/redistance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tactus::carve {

namespace {

constexpr int side = volume::brick_side + 2;  // a brick with a border of one sample
constexpr std::array<int, 3> stride{1, side, side* side};
constexpr double far_away = 1e9;
constexpr double noticed = 5e-6;  // m: smaller changes are not written

struct Block {
    std::array<double, side * side * side> d, u;  // the field; the magnitude of the new one
    std::array<bool, side * side * side> fixed;
    Vec3 spacing;

    double upwind_gradient(int at) const noexcept {
        const auto n = static_cast<std::size_t>(at);
        const double sign = d[n] <= 0.0 ? -1.0 : 1.0;
        double sum = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto step = static_cast<std::size_t>(stride[static_cast<std::size_t>(axis)]);
            const double down = sign * (d[n] - d[n - step]), up = sign * (d[n] - d[n + step]);
            const double slope = std::max({0.0, down, up}) / spacing[axis];
            sum += slope * slope;
        }
        return std::sqrt(sum);
    }

    bool beside_surface(int at) const noexcept {
        const auto n = static_cast<std::size_t>(at);
        for (const int s : stride) {
            const auto step = static_cast<std::size_t>(s);
            if ((d[n] <= 0.0) != (d[n - step] <= 0.0) || (d[n] <= 0.0) != (d[n + step] <= 0.0)) return true;
        }
        return false;
    }

    /// Smallest u that solves the upwind scheme |∇u| = 1 with its lower neighbours.
    double solve(int at) const noexcept {
        const auto n = static_cast<std::size_t>(at);
        std::array<std::pair<double, double>, 3> lower;  // neighbour, spacing
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto step = static_cast<std::size_t>(stride[axis]);
            // A neighbour across the surface has the opposite sign.
            const auto seen = [&](std::size_t m) { return (d[m] <= 0.0) == (d[n] <= 0.0) ? u[m] : -u[m]; };
            lower[axis] = {std::min(seen(n - step), seen(n + step)), spacing[static_cast<int>(axis)]};
        }
        std::ranges::sort(lower);
        double best = far_away, a = 0.0, b = 0.0, c = -1.0;
        for (const auto& [value, h] : lower) {
            if (value >= best) break;
            const double weight = 1.0 / (h * h);
            a += weight;
            b += weight * value;
            c += weight * value * value;
            best = (b + std::sqrt(std::max(0.0, b * b - a * c))) / a;
        }
        return std::max(best, 0.0);
    }
};

template <class Each>
void inner(Each&& each, int order = 0) {
    for (int z = 1; z <= volume::brick_side; ++z) {
        for (int y = 1; y <= volume::brick_side; ++y) {
            for (int x = 1; x <= volume::brick_side; ++x) {
                const int ox = order & 1 ? side - 1 - x : x, oy = order & 2 ? side - 1 - y : y;
                const int oz = order & 4 ? side - 1 - z : z;
                each(ox, oy, oz, (oz * side + oy) * side + ox);
            }
        }
    }
}

}  // namespace

void Redistance::prepare(const volume::BoneEditor& bone, double reach) {
    queue_.assign(static_cast<std::size_t>(bone.layout().brick_count()), 0);
    queued_.assign(queue_.size(), 0);
    head_ = count_ = 0;
    reach_ = reach;
}

void Redistance::push(std::uint32_t brick) noexcept {
    if (brick >= queued_.size() || queued_[brick]) return;
    queued_[brick] = 1;
    queue_[(head_ + count_++) % queue_.size()] = brick;
}

void Redistance::add(std::span<const std::uint32_t> bricks) noexcept {
    for (const std::uint32_t brick : bricks) push(brick);
}

std::size_t Redistance::tick(volume::BoneEditor& bone, int bricks) noexcept {
    const volume::BrickLayout& layout = bone.layout();
    for (; bricks > 0 && count_ > 0; --bricks) {
        if (bone.dirty_left() < 27) break;  // samples on a brick's border belong to its neighbours too
        const std::uint32_t brick = queue_[head_];
        head_ = (head_ + 1) % queue_.size();
        --count_;
        queued_[brick] = 0;

        const int b = static_cast<int>(brick);
        const std::array<int, 3> at{b % layout.bricks[0], b / layout.bricks[0] % layout.bricks[1],
                                    b / layout.bricks[0] / layout.bricks[1]};
        const std::array<int, 3> first{8 * at[0] - 1, 8 * at[1] - 1, 8 * at[2] - 1};
        Block block;
        block.spacing = layout.spacing;
        for (int z = 0; z < side; ++z) {
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) {
                    const auto n = static_cast<std::size_t>((z * side + y) * side + x);
                    block.d[n] = static_cast<double>(bone.get(std::clamp(first[0] + x, 0, layout.size[0] - 1),
                                                              std::clamp(first[1] + y, 0, layout.size[1] - 1),
                                                              std::clamp(first[2] + z, 0, layout.size[2] - 1)));
                    block.u[n] = std::abs(block.d[n]);
                    block.fixed[n] = true;
                }
            }
        }
        bool wrong = false;
        inner([&](int, int, int, int n) {
            if (block.u[static_cast<std::size_t>(n)] >= reach_) return;
            wrong |= std::abs(block.upwind_gradient(n) - 1.0) > 0.05;
        });
        if (!wrong) continue;
        inner([&](int, int, int, int n) {
            const auto m = static_cast<std::size_t>(n);
            if (std::abs(block.d[m]) >= reach_) return;
            block.fixed[m] = block.beside_surface(n);
            block.u[m] = block.fixed[m] ? std::abs(block.d[m]) / std::max(block.upwind_gradient(n), 0.1) : far_away;
        });
        for (int order = 0; order < 8; ++order) {
            inner(
                [&](int, int, int, int n) {
                    const auto m = static_cast<std::size_t>(n);
                    if (!block.fixed[m]) block.u[m] = std::min(block.u[m], block.solve(n));
                },
                order);
        }
        bool changed = false;
        inner([&](int x, int y, int z, int n) {
            const auto m = static_cast<std::size_t>(n);
            const double d = block.d[m] <= 0.0 ? -block.u[m] : block.u[m];
            if (block.u[m] >= far_away || std::abs(d - block.d[m]) < noticed) return;
            changed |= bone.set(first[0] + x, first[1] + y, first[2] + z, static_cast<float>(d)) &&
                       std::abs(d - block.d[m]) > 4.0 * noticed;
        });
        if (!changed) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int step = axis == 0 ? 1 : axis == 1 ? layout.bricks[0] : layout.bricks[0] * layout.bricks[1];
            if (at[axis] > 0) push(static_cast<std::uint32_t>(b - step));
            if (at[axis] + 1 < layout.bricks[axis]) push(static_cast<std::uint32_t>(b + step));
        }
    }
    return count_;
}

}  // namespace tactus::carve
