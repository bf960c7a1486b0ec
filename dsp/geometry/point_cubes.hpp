// SPDX-License-Identifier: Apache-2.0
// Fixed-radius search for points that are hashed into cubes of space.
#pragma once

#include "dsp/core/random.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tactus::geometry {

/// Cubes of space in the slots of a table. Two cubes may share a slot.
class CubeTable {
public:
    using Cell = std::array<std::int64_t, 3>;

    /// `side` of a cube, m; `slots`: a power of two.
    CubeTable(double side, std::size_t slots) : side_(side), mask_(slots - 1) {}

    Cell cell(const Vec3& p) const { return {along(p.x), along(p.y), along(p.z)}; }
    std::uint32_t slot(const Cell& c) const {
        const auto bits = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x1fffff; };
        return static_cast<std::uint32_t>(mix(bits(c[0]) | bits(c[1]) << 21 | bits(c[2]) << 42) & mask_);
    }
    /// The nearer neighbour of a cube along an axis.
    std::int64_t beside(double x, std::int64_t cell) const {
        return x / side_ - static_cast<double>(cell) < 0.5 ? -1 : 1;
    }

private:
    std::int64_t along(double x) const { return static_cast<std::int64_t>(std::floor(x / side_)); }

    double side_;
    std::size_t mask_;
};

/// Points that are added one by one, in cubes with a side of two radii: a ball overlaps at most eight cubes. Its own
/// cube is searched first.
class GrowingCubes {
public:
    /// `radius`: the largest of a query.
    GrowingCubes(std::size_t expected, double radius)
        : table_(2.001 * radius, std::bit_ceil(expected + 1)), head_(std::bit_ceil(expected + 1), none) {}

    void add(const Vec3& p) {
        const std::uint32_t slot = table_.slot(table_.cell(p));
        points_.push_back({p, head_[slot]});
        head_[slot] = static_cast<std::uint32_t>(points_.size() - 1);
    }

    /// Calls visit(index, distance²) for all points within `radius`; stops when it returns false. A point is visited
    /// twice if two cubes have the same slot.
    template <class Visit>
    void around(const Vec3& p, double radius, const Visit& visit) const {
        const auto [x, y, z] = table_.cell(p);
        const std::int64_t bx = table_.beside(p.x, x), by = table_.beside(p.y, y), bz = table_.beside(p.z, z);
        for (int n = 0; n < 8; ++n) {
            const std::uint32_t slot = table_.slot({x + (n & 1 ? bx : 0), y + (n & 2 ? by : 0), z + (n & 4 ? bz : 0)});
            for (std::uint32_t i = head_[slot]; i != none; i = points_[i].next) {
                const Vec3 apart = points_[i].place - p;
                const double d2 = glm::dot(apart, apart);
                if (d2 <= radius * radius && !visit(i, d2)) return;
            }
        }
    }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    struct Entry {
        Vec3 place;
        std::uint32_t next;  // in the same slot
    };

    CubeTable table_;
    std::vector<std::uint32_t> head_;
    std::vector<Entry> points_;
};

/// Steps from a cube to itself, first, and to the 26 cubes around it.
inline constexpr std::array<std::array<int, 3>, 27> cube_steps = [] {
    std::array<std::array<int, 3>, 27> steps{};
    std::size_t n = 1;
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x)
                if (x != 0 || y != 0 || z != 0) steps[n++] = {x, y, z};
    return steps;
}();

/// Points with normals, all given at construction. The points of a slot are contiguous in memory.
class PackedCubes {
public:
    struct Entry {
        Vec3 place, normal;
        std::uint32_t index = 0;  ///< in the given lists
    };
    /// The slots of a cube, first, and of the cubes around it. Queries in spatial order reuse it.
    struct Block {
        CubeTable::Cell cell{std::numeric_limits<std::int64_t>::max(), 0, 0};
        std::array<std::uint32_t, 27> slots{};
    };

    /// `radius`: the largest of a query.
    PackedCubes(std::span<const Vec3> places, std::span<const Vec3> normals, double radius)
        : side_(1.001 * radius),
          table_(side_, std::bit_ceil(places.size() / 4 + 1)),
          first_(std::bit_ceil(places.size() / 4 + 1) + 1, 0),
          entries_(places.size()) {
        std::vector<std::uint32_t> slot(places.size());
        for (std::size_t n = 0; n < places.size(); ++n) {
            slot[n] = table_.slot(table_.cell(places[n]));
            ++first_[slot[n] + 1];
        }
        for (std::size_t s = 1; s < first_.size(); ++s) first_[s] += first_[s - 1];
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t n = 0; n < places.size(); ++n)
            entries_[next[slot[n]]++] = {places[n], normals[n], static_cast<std::uint32_t>(n)};
    }

    std::size_t slots() const { return first_.size() - 1; }
    std::span<const Entry> in(std::size_t slot) const {
        return std::span(entries_).subspan(first_[slot], first_[slot + 1] - first_[slot]);
    }
    /// All points, in the order of the slots.
    std::span<const Entry> all() const { return entries_; }

    /// Returns the slots that contain all points within the radius of `p`.
    const Block& around(const Vec3& p, Block& block) const {
        const CubeTable::Cell cell = table_.cell(p);
        if (cell == block.cell) return block;
        block.cell = cell;
        for (std::size_t n = 0; n < cube_steps.size(); ++n)
            block.slots[n] =
                table_.slot({cell[0] + cube_steps[n][0], cell[1] + cube_steps[n][1], cell[2] + cube_steps[n][2]});
        return block;
    }
    /// Returns the squared distances, m², from a position to the cubes of its block.
    std::array<double, 27> apart2(const Vec3& p, const Block& block) const {
        std::array<std::array<double, 3>, 3> along{};
        for (int a = 0; a < 3; ++a) {
            const double in =
                std::clamp(p[a] - static_cast<double>(block.cell[static_cast<std::size_t>(a)]) * side_, 0.0, side_);
            along[static_cast<std::size_t>(a)] = {in * in, 0.0, (side_ - in) * (side_ - in)};
        }
        std::array<double, 27> squares{};
        for (std::size_t n = 0; n < cube_steps.size(); ++n)
            squares[n] = along[0][static_cast<std::size_t>(cube_steps[n][0] + 1)] +
                         along[1][static_cast<std::size_t>(cube_steps[n][1] + 1)] +
                         along[2][static_cast<std::size_t>(cube_steps[n][2] + 1)];
        return squares;
    }

private:
    double side_;
    CubeTable table_;
    std::vector<std::uint32_t> first_;  // entry of each slot; the last is the number of all
    std::vector<Entry> entries_;
};

}  // namespace tactus::geometry
