// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/export.hpp"

#include "assets/bone/from_hu.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tactus::bone {

namespace {

constexpr float air = -1000.0f;

float threshold_of(const Bone& bone) {
    const auto text = bone.provenance.find("threshold");
    const double value = text == bone.provenance.end() ? 300.0 : std::strtod(text->second.c_str(), nullptr);
    return std::isfinite(value) ? static_cast<float>(value) : 300.0f;
}

// Removed bone must not appear in the volume: outside the surface the values fall from the threshold to air within one
// voxel.
float hu_at(const Bone& bone, std::size_t n, float threshold, float voxel) {
    const float hu = hu_of_density(bone.density.values[n]), d = bone.distance.values[n];
    if (d <= -voxel) return hu;
    const float edge = threshold - (threshold - air) * d / voxel;
    return std::max(d < 0.0f ? std::min(std::max(hu, threshold + 1.0f), edge) : std::min(hu, edge), air);
}

float value_at(const Bone& bone, std::size_t n, BoneQuantity quantity, float threshold, float voxel) {
    if (quantity == BoneQuantity::distance) return bone.distance.values[n] * 1e3f;
    if (quantity == BoneQuantity::density) return bone.distance.values[n] < 0.0f ? bone.density.values[n] : 0.0f;
    return hu_at(bone, n, threshold, voxel);
}

// Offset in samples from `base` to the first sample of `grid`. Throws when the two lattices differ.
std::array<int, 3> steps_between(const volume::Grid& base, const volume::Grid& grid) {
    std::array<int, 3> steps{};
    for (int axis = 0; axis < 3; ++axis) {
        const double apart = (grid.origin[axis] - base.origin[axis]) / base.spacing[axis];
        if (std::abs(grid.spacing[axis] - base.spacing[axis]) > 1e-6 * base.spacing[axis] ||
            std::abs(apart - std::round(apart)) > 1e-3 || std::abs(apart) > 1e6)
            throw Error(
                "the bones have different grids and do not fit into one volume; export them one by one with --bone");
        steps[static_cast<std::size_t>(axis)] = static_cast<int>(std::round(apart));
    }
    return steps;
}

}  // namespace

volume::Grid volume_of_bones(std::span<const Bone> bones, BoneQuantity quantity) {
    if (bones.empty()) throw Error("there is no bone to export");
    const volume::Grid& base = bones.front().distance;
    std::array<int, 3> first{}, last{};
    for (const Bone& bone : bones) {
        const auto steps = steps_between(base, bone.distance);
        for (std::size_t a = 0; a < 3; ++a) {
            first[a] = std::min(first[a], steps[a]);
            last[a] = std::max(last[a], steps[a] + bone.distance.size[a] - 1);
        }
    }
    volume::Grid out{{}, base.position(first[0], first[1], first[2]), base.spacing, {}};
    double count = 1.0;
    for (std::size_t a = 0; a < 3; ++a) out.size[a] = last[a] - first[a] + 1, count *= out.size[a];
    if (count > 1e9) throw Error("the bones lie too far apart for one volume; export them one by one with --bone");
    const bool least = quantity == BoneQuantity::distance;
    out.values.assign(out.count(), quantity == BoneQuantity::hu ? air : least ? 1000.0f : 0.0f);
    const auto voxel = static_cast<float>(std::min({base.spacing.x, base.spacing.y, base.spacing.z}));
    for (const Bone& bone : bones) {
        const auto steps = steps_between(base, bone.distance);
        const float threshold = threshold_of(bone);
        const auto& size = bone.distance.size;
        std::size_t n = 0;
        for (int k = 0; k < size[2]; ++k)
            for (int j = 0; j < size[1]; ++j)
                for (int i = 0; i < size[0]; ++i, ++n) {
                    float& to = out.at(i + steps[0] - first[0], j + steps[1] - first[1], k + steps[2] - first[2]);
                    const float value = value_at(bone, n, quantity, threshold, voxel);
                    to = least ? std::min(to, value) : std::max(to, value);
                }
    }
    return out;
}

}  // namespace tactus::bone
