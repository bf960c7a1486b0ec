// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/from_hu.hpp"

#include "dsp/core/error.hpp"
#include "dsp/distance/components.hpp"
#include "dsp/distance/iso_distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus {

namespace {

constexpr int margin = 4;
constexpr float air = -1000.0f;
constexpr double density_slope = 1.067, density_offset = 131.0;

Grid with_margin(const Grid& in, float value) {
    Grid out{in.size, in.origin - static_cast<double>(margin) * in.spacing, in.spacing, {}};
    for (int& n : out.size) n += 2 * margin;
    out.values.assign(out.count(), value);
    for (int k = 0; k < in.size[2]; ++k)
        for (int j = 0; j < in.size[1]; ++j)
            std::copy_n(&in.values[in.index(0, j, k)], in.size[0], &out.values[out.index(margin, j + margin, k + margin)]);
    return out;
}

// Fills the margin: what touches the border at or above iso is mirrored about it, which puts the face half a voxel out.
void close_border(Grid& grey, float iso) {
    const auto& size = grey.size;
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i) {
                const int x = std::clamp(i, margin, size[0] - 1 - margin), y = std::clamp(j, margin, size[1] - 1 - margin);
                const int z = std::clamp(k, margin, size[2] - 1 - margin);
                if (x == i && y == j && z == k) continue;
                const float edge = grey.at(x, y, z);
                grey.at(i, j, k) = edge >= iso ? std::min(2.0f * iso - edge, iso - 1.0f) : edge;
            }
}

int smoothing_passes(const Vec3& spacing) {
    const double voxel = std::max({spacing.x, spacing.y, spacing.z}), wanted = 0.35e-3;
    return static_cast<int>(std::clamp(std::round(3.0 * wanted * wanted / (voxel * voxel)), 0.0, 3.0));
}

}  // namespace

float density_of_hu(float hu) {
    return std::max(0.0f, static_cast<float>(density_slope * static_cast<double>(hu) + density_offset));
}

std::string density_calibration() {
    return fmt::format("uncalibrated: density = {} * HU + {} kg/m3 (mg/cm3), at least 0; line of Rho, Hobatho and Ashman "
                       "1995, no phantom in the scan",
                       density_slope, density_offset);
}

HuBone bone_from_hu(const Grid& hu, const BoneSurface& surface) {
    const float iso = surface.threshold;
    HuBone result;
    result.bone.density = with_margin(hu, air);
    Grid grey = result.bone.density;
    for (float& value : result.bone.density.values) value = density_of_hu(value);
    close_border(grey, iso);
    for (int pass = smoothing_passes(hu.spacing); pass > 0; --pass) grey = smoothed(grey);
    const Components components = components_above(grey, iso);
    if (components.voxels.empty())
        throw Error(fmt::format("nothing in the volume reaches {} HU, so there is no bone; lower the threshold or move "
                                "the crop box",
                                iso));
    result.components = components.voxels.size();
    if (surface.keep > 0) keep_largest(grey, iso, components, surface.keep);
    if (surface.fill) fill_hollows(grey, iso);
    result.bone.distance = distance_to_iso(grey, iso);
    result.bone.provenance["frame"] = "LPS";
    result.bone.provenance["calibration"] = density_calibration();
    result.bone.provenance["threshold"] = fmt::format("{} HU", iso);
    return result;
}

}  // namespace tactus
