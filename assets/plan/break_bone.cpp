// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/break_bone.hpp"

#include "assets/plan/rough_surface.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/error.hpp"
#include "dsp/geometry/main_axes.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace tactus::plan {

namespace {

constexpr double slab = 4e-3;        // m: thickness of the layer around the fracture that follows its relief
constexpr double min_share = 0.2;  // smallest share of a piece's volume on each side of its fracture
constexpr int attempts = 40;
constexpr std::size_t min_samples = 500;

std::array<int, 3> place(const volume::Grid& grid, std::size_t n) {
    const auto nx = static_cast<std::size_t>(grid.size[0]), ny = static_cast<std::size_t>(grid.size[1]);
    return {static_cast<int>(n % nx), static_cast<int>(n / nx % ny), static_cast<int>(n / nx / ny)};
}

Vec3 position(const volume::Grid& grid, std::size_t n) {
    const auto [i, j, k] = place(grid, n);
    return grid.position(i, j, k);
}

/// Calls visit(index) for the neighbours along the axes.
template <class Visit>
void around(const volume::Grid& grid, std::size_t n, const Visit& visit) {
    const auto at = place(grid, n);
    const std::size_t step[3] = {1, static_cast<std::size_t>(grid.size[0]),
                                 static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1])};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (at[axis] > 0) visit(n - step[axis]);
        if (at[axis] + 1 < grid.size[axis]) visit(n + step[axis]);
    }
}

std::size_t samples_inside(const volume::Grid& solid) {
    return static_cast<std::size_t>(std::ranges::count_if(solid.values, [](float d) { return d < 0.0f; }));
}

/// The bounding box of the inside samples with a margin of three samples.
volume::Grid cropped(const volume::Grid& solid) {
    std::array<int, 3> first = solid.size, last{-1, -1, -1};
    for (std::size_t n = 0; n < solid.values.size(); ++n) {
        if (!(solid.values[n] < 0.0f)) continue;
        const auto at = place(solid, n);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = std::min(first[axis], at[axis]);
            last[axis] = std::max(last[axis], at[axis]);
        }
    }
    volume::Grid small;
    small.spacing = solid.spacing;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = std::max(first[axis] - 3, 0);
        small.size[axis] = std::min(last[axis] + 3, solid.size[axis] - 1) - first[axis] + 1;
    }
    small.origin = solid.position(first[0], first[1], first[2]);
    small.values.reserve(small.count());
    for (int k = 0; k < small.size[2]; ++k)
        for (int j = 0; j < small.size[1]; ++j)
            for (int i = 0; i < small.size[0]; ++i)
                small.values.push_back(solid.at(first[0] + i, first[1] + j, first[2] + k));
    return small;
}

/// Longest axis of a set of points.
Vec3 long_axis(const std::vector<Vec3>& points, const Vec3& middle) {
    Mat3 spread(0.0);
    for (const Vec3& p : points) spread += glm::outerProduct(p - middle, p - middle);
    const Vec3 axis = geometry::main_axes(spread)[0];
    return glm::dot(axis, Vec3(0.62, 0.53, 0.58)) < 0.0 ? -axis : axis;
}

Vec3 any_normal_to(const Vec3& axis) {
    const Vec3 other = std::abs(axis.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    return glm::normalize(glm::cross(axis, other));
}

/// Signed distance (m, to first order) to a rough surface through a point; negative behind it.
struct Crack {
    Vec3 at, normal, u, v;
    RoughSurface rough;

    double operator()(const Vec3& p) const {
        const Vec3 r = p - at;
        return (glm::dot(r, normal) - rough(glm::dot(r, u), glm::dot(r, v))) / std::hypot(1.0, rough.slope());
    }
};

struct Split {
    std::vector<float> side;  ///< per sample: distance to the crack, clamped to ±slab; NaN outside the bone
    std::vector<std::size_t> surface;  ///< inside samples next to the crack
};

/// Grows a crack through the piece from its start: other parts of the piece that its plane crosses stay whole. None
/// when the crack does not separate the piece, or when one side is too small.
std::optional<Split> follow(const volume::Grid& solid, const Crack& crack, std::size_t start, std::size_t inside) {
    const double step = std::max({solid.spacing.x, solid.spacing.y, solid.spacing.z}), band = 2.0 * step;
    constexpr std::uint8_t unseen = 0, near = 1, behind = 2;
    std::vector<std::uint8_t> state(solid.count(), unseen);
    Split split;
    split.side.assign(solid.count(), std::numeric_limits<float>::quiet_NaN());
    std::vector<std::size_t> queue{start};
    state[start] = near;
    for (std::size_t q = 0; q < queue.size(); ++q) {
        split.side[queue[q]] = static_cast<float>(crack(position(solid, queue[q])));
        around(solid, queue[q], [&](std::size_t m) {
            if (state[m] != unseen || !(solid.values[m] < band) || std::abs(crack(position(solid, m))) > slab) return;
            state[m] = near;
            queue.push_back(m);
        });
    }
    for (const std::size_t n : queue)
        if (std::abs(split.side[n]) < 0.6 * step && solid.values[n] < 0.0f) split.surface.push_back(n);
    // Flood fill from behind the crack without crossing it.
    std::vector<std::size_t> flood;
    std::size_t volume = 0;
    for (const std::size_t n : queue)
        if (split.side[n] < 0.0f) {
            state[n] = behind;
            flood.push_back(n);
        }
    for (std::size_t q = 0; q < flood.size(); ++q) {
        volume += solid.values[flood[q]] < 0.0f;
        const bool in_slab = !std::isnan(split.side[flood[q]]);
        bool through = false;
        around(solid, flood[q], [&](std::size_t m) {
            if (state[m] == near) {
                through = through || !in_slab;
                return;
            }
            if (state[m] != unseen || !(solid.values[m] < band)) return;
            state[m] = behind;
            flood.push_back(m);
        });
        if (through) return std::nullopt;
    }
    const double share = static_cast<double>(volume) / static_cast<double>(inside);
    if (share < min_share || share > 1.0 - min_share || split.surface.empty()) return std::nullopt;
    for (std::size_t n = 0; n < state.size(); ++n) {
        if (!std::isnan(split.side[n]) || !(solid.values[n] < band)) continue;
        split.side[n] = static_cast<float>(state[n] == behind ? -slab : slab);
    }
    return split;
}

struct Chip {
    Vec3 centre;
    double radius;
    bool from_behind;  ///< the side that loses the chip
};

/// Chips along the crack, each off one of its sides, until they cover the wanted share.
std::vector<Chip> chips_of(const volume::Grid& solid, const Split& split, const Crack& crack,
                           const BreakOptions& options, const Random& random) {
    std::vector<Chip> chips;
    std::vector<bool> covered(split.surface.size(), false);
    std::size_t count = 0;
    const auto wanted = static_cast<std::size_t>(options.chips * static_cast<double>(split.surface.size()));
    for (std::uint64_t draw = 1000; count < wanted && draw < 100'000; draw += 4) {
        const auto pick = static_cast<std::size_t>(random.uniform(draw) * static_cast<double>(split.surface.size()));
        const Vec3 at = position(solid, split.surface[pick]);
        const double depth = options.chip_depth * (0.4 + 0.6 * random.uniform(draw + 1));
        const double opening = depth * (1.0 + random.uniform(draw + 2));
        const double radius = 0.5 * (opening * opening + depth * depth) / depth;
        const bool from_behind = random.uniform(draw + 3) < 0.5;
        chips.push_back({at + crack.normal * ((from_behind ? 1.0 : -1.0) * (radius - depth)), radius, from_behind});
        for (std::size_t n = 0; n < covered.size(); ++n)
            if (!covered[n] && glm::length(position(solid, split.surface[n]) - at) < opening) {
                covered[n] = true;
                ++count;
            }
    }
    return chips;
}

volume::Grid side_of(const volume::Grid& solid, const Split& split, bool behind, const std::vector<Chip>& chips,
                     double kerf) {
    volume::Grid part = solid;
    for (std::size_t n = 0; n < part.values.size(); ++n) {
        if (std::isnan(split.side[n])) continue;
        const float side = (behind ? split.side[n] : -split.side[n]) + static_cast<float>(0.5 * kerf);
        part.values[n] = std::max(part.values[n], side);
        if (!(std::abs(split.side[n]) < slab) || !(part.values[n] < 0.5f * static_cast<float>(slab))) continue;
        const Vec3 p = position(solid, n);
        for (const Chip& chip : chips)
            if (chip.from_behind == behind)
                part.values[n] =
                    std::max(part.values[n], static_cast<float>(chip.radius - glm::length(p - chip.centre)));
    }
    return cropped(part);
}

std::array<volume::Grid, 2> break_in_two(const volume::Grid& solid, const BreakOptions& options, std::uint64_t seed) {
    std::vector<std::size_t> inside;
    for (std::size_t n = 0; n < solid.values.size(); ++n)
        if (solid.values[n] < 0.0f) inside.push_back(n);
    std::vector<Vec3> some;
    Vec3 middle(0.0);
    const std::size_t stride = std::max<std::size_t>(1, inside.size() / 5000);
    for (std::size_t n = 0; n < inside.size(); n += stride) some.push_back(position(solid, inside[n]));
    for (const Vec3& p : some) middle += p / static_cast<double>(some.size());
    const Vec3 axis = long_axis(some, middle), across = any_normal_to(axis);
    std::vector<double> along;
    for (const Vec3& p : some) along.push_back(glm::dot(p, axis));
    std::ranges::sort(along);
    for (int attempt = 0; attempt < attempts; ++attempt) {
        const Random random{seed * 977 + static_cast<std::uint64_t>(attempt)};
        const auto rank = static_cast<std::size_t>((1.0 + random.uniform(0)) / 3.0 * static_cast<double>(along.size()));
        // Start of a crack: the sample nearest to a chosen position along the axis; the search begins at a random
        // sample.
        const std::size_t first = random.bits(1) % inside.size();
        std::size_t start = inside[first];
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t n = 0; n < inside.size() && nearest > 0.25e-3; n += 7) {
            const std::size_t sample = inside[(first + n) % inside.size()];
            const double away = std::abs(glm::dot(position(solid, sample), axis) - along[rank]);
            if (away < nearest) nearest = away, start = sample;
        }
        const double lean = options.tilt * random.uniform(2), way = 2.0 * std::numbers::pi * random.uniform(3);
        const Vec3 to = std::cos(way) * across + std::sin(way) * glm::cross(axis, across);
        const Vec3 normal = std::cos(lean) * axis + std::sin(lean) * to, u = any_normal_to(normal);
        const Crack crack{position(solid, start), normal, u, glm::cross(normal, u),
                          RoughSurface(options.roughness, random.bits(4))};
        // The relief displaces the crack from the start; shift it along the normal so that it passes through the start.
        Crack through = crack;
        through.at += normal * (-crack.rough(0.0, 0.0));
        const auto split = follow(solid, through, start, inside.size());
        if (!split) continue;
        const std::vector<Chip> chips = chips_of(solid, *split, through, options, random);
        return {side_of(solid, *split, true, chips, options.kerf), side_of(solid, *split, false, chips, options.kerf)};
    }
    throw Error("the bone cannot be broken into that many pieces: no further piece can be broken; ask for fewer");
}

}  // namespace

std::vector<volume::Grid> break_bone(const volume::Grid& distance, const BreakOptions& options) {
    if (options.pieces < 2 || options.pieces > 200) throw Error("the number of pieces must be 2 to 200");
    if (!(options.chips >= 0.0 && options.chips <= 0.9)) throw Error("chips must take 0 to 90 % of a fracture's area");
    if (!(options.kerf >= 0.0 && options.kerf < 5e-3)) throw Error("the kerf must be between 0 and 5 mm");
    if (!(options.roughness >= 0.0 && options.roughness < 5e-3))
        throw Error("the roughness must be between 0 and 5 mm");
    if (!(options.chip_depth > 0.0 && options.chip_depth < 10e-3))
        throw Error("chips must be between 0 and 10 mm deep");
    if (samples_inside(distance) < min_samples * static_cast<std::size_t>(options.pieces))
        throw Error(fmt::format("the bone has {} samples inside, too few for {} pieces; use smaller voxels",
                                samples_inside(distance), options.pieces));
    std::vector<volume::Grid> pieces{cropped(distance)};
    while (pieces.size() < static_cast<std::size_t>(options.pieces)) {
        const auto largest = std::ranges::max_element(pieces, {}, samples_inside);
        auto [behind, before] = break_in_two(*largest, options, options.seed * 131 + pieces.size());
        *largest = std::move(behind);
        pieces.push_back(std::move(before));
    }
    return pieces;
}

}  // namespace tactus::plan
