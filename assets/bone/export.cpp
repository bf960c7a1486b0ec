// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/export.hpp"

#include "assets/bone/from_hu.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace tactus::bone {

namespace {

constexpr float air = -1000.0f, lowest_surface = -800.0f;  // HU: the field rises from air to the surface

float threshold_of(const Bone& bone) {
    const auto text = bone.provenance.find("threshold");
    const double value = text == bone.provenance.end() ? 300.0 : std::strtod(text->second.c_str(), nullptr);
    return std::isfinite(value) ? static_cast<float>(value) : 300.0f;
}

// HU of the samples of a bone, and air around them: removed bone must not appear in the volume. On each grid edge that
// the surface crosses the HU are linear in the distance, with the surface value where it is 0. Therefore the value
// of the sample outside continues the slope of its neighbours inside. With a fixed slope the surface would move towards
// the side with the smaller difference: 0.4 voxels into a bone of 400 HU.
class HuOfBone {
public:
    HuOfBone(const Bone& bone, float surface)
        : bone_(bone),
          surface_(std::max(surface, lowest_surface)),
          voxel_(static_cast<float>(
              std::max({bone.distance.spacing.x, bone.distance.spacing.y, bone.distance.spacing.z}))) {}

    float at(int i, int j, int k) const {
        const std::size_t n = bone_.distance.index(i, j, k);
        return bone_.distance.values[n] < 0.0f ? inside(n) : outside(i, j, k);
    }

private:
    float inside(std::size_t n) const {
        constexpr float min_rise = 100.0f;  // HU per voxel; above the rounding to whole numbers
        const float hu = hu_of_density(bone_.density.values[n]), depth = -bone_.distance.values[n];
        if (depth >= voxel_) return hu;
        return std::clamp(hu, surface_ + min_rise * depth / voxel_, surface_ + (surface_ - air) * depth / voxel_);
    }

    // Also of the second sample, since an import smooths small voxels: air there would move the surface inwards.
    float outside(int i, int j, int k) const {
        const volume::Grid& grid = bone_.distance;
        for (const int reach : {1, 2}) {
            float rise = 0.0f, depth = 0.0f;
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const int step : {-reach, reach}) {
                    std::array<int, 3> at{i, j, k};
                    at[axis] += step;
                    if (at[axis] < 0 || at[axis] >= grid.size[axis]) continue;
                    const std::size_t n = grid.index(at[0], at[1], at[2]);
                    if (grid.values[n] >= 0.0f) continue;
                    rise += inside(n) - surface_;
                    depth -= grid.values[n];
                }
            if (depth > 0.0f && rise > 0.0f)
                return std::clamp(surface_ - rise / depth * grid.at(i, j, k), air, surface_ - 1.0f);
        }
        return air;
    }

    const Bone& bone_;
    const float surface_, voxel_;
};

float value_at(const Bone& bone, int i, int j, int k, BoneQuantity quantity, float surface) {
    const float distance = bone.distance.at(i, j, k);
    if (quantity == BoneQuantity::distance) return distance * 1e3f;
    if (quantity == BoneQuantity::density) return distance < 0.0f ? bone.density.at(i, j, k) : 0.0f;
    return HuOfBone(bone, surface).at(i, j, k);
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

double surface_hu(std::span<const Bone> bones) {
    float lowest = std::numeric_limits<float>::infinity();
    for (const Bone& bone : bones) lowest = std::min(lowest, threshold_of(bone));
    return static_cast<double>(lowest);
}

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
    const auto surface = static_cast<float>(surface_hu(bones));
    for (const Bone& bone : bones) {
        const auto steps = steps_between(base, bone.distance);
        const auto& size = bone.distance.size;
        for (int k = 0; k < size[2]; ++k)
            for (int j = 0; j < size[1]; ++j)
                for (int i = 0; i < size[0]; ++i) {
                    float& to = out.at(i + steps[0] - first[0], j + steps[1] - first[1], k + steps[2] - first[2]);
                    const float value = value_at(bone, i, j, k, quantity, surface);
                    to = least ? std::min(to, value) : std::max(to, value);
                }
    }
    return out;
}

}  // namespace tactus::bone
