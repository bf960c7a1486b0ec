// SPDX-License-Identifier: Apache-2.0
#include "dsp/geometry/brick_surface.hpp"

#include "dsp/geometry/tetrahedra.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::geometry {

namespace {

/// One brick and its neighbourhood.
struct BrickField {
    const volume::BoneSnapshot& bone;
    const float* samples;
    std::array<int, 3> first;  // sample of the grid at the brick's low corner

    float at(int x, int y, int z) const noexcept { return samples[volume::BrickLayout::sample_index(x, y, z)]; }

    Vec3 position(int x, int y, int z) const noexcept {
        return bone.layout().origin + Vec3(first[0] + x, first[1] + y, first[2] + z) * bone.layout().spacing;
    }

    /// A sample in or next to the brick; `otherwise` where none is stored.
    double around(int x, int y, int z, double otherwise) const noexcept {
        constexpr auto inside = [](int n) { return n >= 0 && n < volume::brick_side; };
        if (inside(x) && inside(y) && inside(z)) return static_cast<double>(at(x, y, z));
        const volume::BrickLayout& layout = bone.layout();
        const std::array index{first[0] + x, first[1] + y, first[2] + z};
        std::array<int, 3> brick{}, within{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (index[axis] < 0 || index[axis] >= layout.size[axis]) return otherwise;
            brick[axis] = std::min(index[axis] / volume::brick_cells, layout.bricks[axis] - 1);
            within[axis] = index[axis] - volume::brick_cells * brick[axis];
        }
        const float* other =
            bone.root->distance[static_cast<std::size_t>(layout.brick_index(brick[0], brick[1], brick[2]))];
        return other ? static_cast<double>(other[volume::BrickLayout::sample_index(within[0], within[1], within[2])])
                     : otherwise;
    }

    /// By central differences, one-sided where a neighbour is missing.
    Vec3 gradient(int x, int y, int z) const noexcept {
        const double here = static_cast<double>(at(x, y, z));
        const Vec3 step(around(x + 1, y, z, here) - around(x - 1, y, z, here),
                        around(x, y + 1, z, here) - around(x, y - 1, z, here),
                        around(x, y, z + 1, here) - around(x, y, z - 1, here));
        return step / bone.layout().spacing;
    }

    /// Density below the surface. `inside` is the next sample inside the bone; it serves at sharp edges, where the path
    /// inwards leaves the bone again.
    double density(const Vec3& position, const Vec3& outwards, const Vec3& inside) const noexcept {
        const double voxel = bone.layout().spacing.x;
        double most = bone.density(inside);
        for (const double depth : {0.75, 1.5, 2.5, 3.5})
            most = std::max(most, bone.density(position - outwards * (depth * voxel)));
        return most;
    }
};

}  // namespace

Vec3 DensityColours::operator()(double density) const noexcept {
    return core + (cortex - core) * std::clamp((density - core_density) / (cortex_density - core_density), 0.0, 1.0);
}

std::array<std::int16_t, 4> packed_normal(const Vec3& normal) noexcept {
    const double length = glm::length(normal);
    if (!(length > 0.0)) return {0, 0, 32767, 0};
    std::array<std::int16_t, 4> packed{};
    for (int axis = 0; axis < 3; ++axis)
        packed[static_cast<std::size_t>(axis)] =
            static_cast<std::int16_t>(std::lround(normal[axis] / length * 32767.0));
    return packed;
}

std::array<std::uint8_t, 4> packed_colour(const Vec3& colour, double opacity) noexcept {
    const auto byte = [](double value) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
    };
    return {byte(colour.x), byte(colour.y), byte(colour.z), byte(opacity)};
}

void BrickSurface::make(const volume::BoneSnapshot& bone, std::uint32_t brick, SurfacePatch& patch) {
    patch.vertices.clear();
    patch.triangles.clear();
    const float* samples = bone.root->distance[brick];
    if (!samples) return;
    // Most bricks lie completely inside or outside the bone.
    const bool inside = samples[0] < 0.0f;
    if (std::all_of(samples, samples + volume::brick_samples, [inside](float d) { return (d < 0.0f) == inside; }))
        return;
    const volume::BrickLayout& layout = bone.layout();
    const auto b = static_cast<int>(brick);
    const BrickField field{
        bone,
        samples,
        {volume::brick_cells * (b % layout.bricks[0]), volume::brick_cells * (b / layout.bricks[0] % layout.bricks[1]),
         volume::brick_cells * (b / layout.bricks[0] / layout.bricks[1])}};
    vertex_.fill(-1);
    const auto vertex = [&](int i, int j, int k, int from, int to) {
        const int x = i + (from & 1), y = j + (from >> 1 & 1), z = k + (from >> 2);
        const int step = from ^ to;
        std::int32_t& slot =
            vertex_[static_cast<std::size_t>(7 * volume::BrickLayout::sample_index(x, y, z) + step - 1)];
        if (slot >= 0) return slot;
        const int u = x + (step & 1), v = y + (step >> 1 & 1), w = z + (step >> 2);
        const double t = crossing(static_cast<double>(field.at(x, y, z)), static_cast<double>(field.at(u, v, w)), 0.0);
        const Vec3 position = glm::mix(field.position(x, y, z), field.position(u, v, w), t);
        Vec3 normal = glm::mix(field.gradient(x, y, z), field.gradient(u, v, w), t);
        const double length = glm::length(normal);
        normal = length > 0.0 ? normal / length : Vec3(0.0, 0.0, 1.0);
        const Vec3 inside_end = field.at(x, y, z) < 0.0f ? field.position(x, y, z) : field.position(u, v, w);
        slot = static_cast<std::int32_t>(patch.vertices.size());
        patch.vertices.push_back(
            {{static_cast<float>(position.x), static_cast<float>(position.y), static_cast<float>(position.z)},
             packed_normal(normal),
             packed_colour(colours(field.density(position, normal, inside_end)))});
        return slot;
    };
    std::array<int, 3> cells{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        cells[axis] = std::min(volume::brick_cells, layout.size[axis] - 1 - field.first[axis]);
    for (int k = 0; k < cells[2]; ++k)
        for (int j = 0; j < cells[1]; ++j)
            for (int i = 0; i < cells[0]; ++i) {
                unsigned bits = 0;
                for (int c = 0; c < 8; ++c)
                    bits |= static_cast<unsigned>(field.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)) < 0.0f) << c;
                if (bits == 0 || bits == 0xff) continue;
                march_cell(
                    bits, [&](int from, int to) { return vertex(i, j, k, from, to); },
                    [&](int p, int q, int r) {
                        for (const int n : {p, q, r}) patch.triangles.push_back(static_cast<std::uint32_t>(n));
                    });
            }
}

}  // namespace tactus::geometry
