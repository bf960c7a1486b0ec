// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/from_hu.hpp"

#include "dsp/core/error.hpp"
#include "dsp/distance/components.hpp"
#include "dsp/distance/iso_distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tactus {

namespace {

constexpr int margin = 4;
constexpr float air = -1000.0f;
constexpr double air_around = 5e-3;  // m
constexpr double density_slope = 1.067, density_offset = 131.0;

using Box = Components::Box;

// The samples of `in` from box.first to box.last, which may reach outside: there stands `value`.
Grid cut_out(const Grid& in, const Box& box, float value) {
    Grid out{{}, in.position(box.first[0], box.first[1], box.first[2]), in.spacing, {}};
    for (std::size_t a = 0; a < 3; ++a) out.size[a] = box.last[a] - box.first[a] + 1;
    out.values.assign(out.count(), value);
    const int x0 = std::max(box.first[0], 0), x1 = std::min(box.last[0], in.size[0] - 1);
    for (int k = std::max(box.first[2], 0); k <= std::min(box.last[2], in.size[2] - 1); ++k)
        for (int j = std::max(box.first[1], 0); j <= std::min(box.last[1], in.size[1] - 1); ++j)
            std::copy_n(&in.values[in.index(x0, j, k)], x1 - x0 + 1,
                        &out.values[out.index(x0 - box.first[0], j - box.first[1], k - box.first[2])]);
    return out;
}

// What stands around the volume (which covers the samples of `inner`): what touches the border at or above iso is
// mirrored about it, which puts the face half a voxel out.
void close_border(Grid& grey, const Box& inner, float iso) {
    const auto& size = grey.size;
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i) {
                const int x = std::clamp(i, inner.first[0], inner.last[0]);
                const int y = std::clamp(j, inner.first[1], inner.last[1]);
                const int z = std::clamp(k, inner.first[2], inner.last[2]);
                if (y == j && z == k && x == i) {
                    i = inner.last[0];  // nothing to do up to the far border
                    continue;
                }
                const float edge = grey.at(x, y, z);
                grey.at(i, j, k) = edge >= iso ? std::min(2.0f * iso - edge, iso - 1.0f) : edge;
            }
}

// Samples of air that bone is given around it, along each axis.
std::array<int, 3> reach_of(const Vec3& spacing) {
    std::array<int, 3> reach{};
    for (int axis = 0; axis < 3; ++axis)
        reach[static_cast<std::size_t>(axis)] = 6 + static_cast<int>(std::ceil(air_around / spacing[axis]));
    return reach;
}

// Only that part of the volume where bone can be, so that what follows needs memory for no more. Smoothing raises no
// sample above its neighbours: `passes` samples away from the last one at the threshold there is no bone.
Grid part_with_bone(Grid hu, float iso, int passes) {
    Box box{hu.size, {-1, -1, -1}};
    for (int k = 0; k < hu.size[2]; ++k)
        for (int j = 0; j < hu.size[1]; ++j) {
            const float* row = &hu.values[hu.index(0, j, k)];
            const float* end = row + hu.size[0];
            const float* first = std::find_if(row, end, [iso](float v) { return v >= iso; });
            if (first == end) continue;
            const float* last = end - 1;
            while (!(*last >= iso)) --last;
            const std::array<int, 3> low{static_cast<int>(first - row), j, k}, high{static_cast<int>(last - row), j, k};
            for (std::size_t a = 0; a < 3; ++a) {
                box.first[a] = std::min(box.first[a], low[a]);
                box.last[a] = std::max(box.last[a], high[a]);
            }
        }
    if (box.last[0] < 0) return hu;
    const std::array<int, 3> reach = reach_of(hu.spacing);
    std::size_t part = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        box.first[a] = std::max(0, box.first[a] - reach[a] - passes - 1);
        box.last[a] = std::min(hu.size[a] - 1, box.last[a] + reach[a] + passes + 1);
        part *= static_cast<std::size_t>(box.last[a] - box.first[a] + 1);
    }
    // A copy of nearly all of it would cost more than it saves.
    return 2 * part > hu.count() ? std::move(hu) : cut_out(hu, box, air);
}

// Samples around the components that are kept: some millimetres of air, but only four layers outside the volume, which
// tell a face where the scan ends.
Box room_around(const Components& components, std::size_t keep, const Grid& hu) {
    Box room = components.boxes.front();
    for (std::size_t n = 1; n < components.boxes.size() && (keep == 0 || n < keep); ++n)
        for (std::size_t a = 0; a < 3; ++a) {
            room.first[a] = std::min(room.first[a], components.boxes[n].first[a]);
            room.last[a] = std::max(room.last[a], components.boxes[n].last[a]);
        }
    const std::array<int, 3> reach = reach_of(hu.spacing);
    for (std::size_t a = 0; a < 3; ++a) {
        room.first[a] = std::max(room.first[a] - reach[a], -margin);
        room.last[a] = std::min(room.last[a] + reach[a], hu.size[a] - 1 + margin);
    }
    return room;
}

// The same runs counted from the room's first sample; what lies outside of it is left out.
Components moved_into(Components components, const Box& room) {
    for (SampleRun& run : components.runs) {
        run.begin = std::max(run.begin, room.first[0]) - room.first[0];
        run.end = std::min(run.end, room.last[0] + 1) - room.first[0];
        run.j -= room.first[1];
        run.k -= room.first[2];
    }
    std::erase_if(components.runs, [&](const SampleRun& run) {
        return run.begin >= run.end || run.j < 0 || run.k < 0 || run.j > room.last[1] - room.first[1] ||
               run.k > room.last[2] - room.first[2];
    });
    return components;
}

int smoothing_passes(const Vec3& spacing) {
    const double voxel = std::max({spacing.x, spacing.y, spacing.z}), wanted = 0.3e-3;
    return static_cast<int>(std::clamp(std::floor(3.0 * wanted * wanted / (voxel * voxel)), 0.0, 3.0));
}

}  // namespace

float density_of_hu(float hu) {
    return std::max(0.0f, static_cast<float>(density_slope * static_cast<double>(hu) + density_offset));
}

float hu_of_density(float density) {
    return static_cast<float>((static_cast<double>(density) - density_offset) / density_slope);
}

std::string density_calibration() {
    return fmt::format(
        "uncalibrated: density = {} * HU + {} kg/m3 (mg/cm3), at least 0; line of Rho, Hobatho and Ashman "
        "1995, no phantom in the scan",
        density_slope, density_offset);
}

HuBone bone_from_hu(Grid hu, const BoneSurface& surface, const RunJobs& run) {
    const float iso = surface.threshold;
    const int passes = smoothing_passes(hu.spacing);
    hu = part_with_bone(std::move(hu), iso, passes);
    Grid smooth;
    for (int pass = passes; pass > 0; --pass)
        smooth = smoothed(smooth.values.empty() ? Grid(hu) : std::move(smooth), run);
    const Grid& seen = smooth.values.empty() ? hu : smooth;
    Components components = components_above(seen, iso);
    if (components.voxels.empty())
        throw Error(
            fmt::format("nothing in the volume reaches {} HU, so there is no bone; lower the threshold or move "
                        "the crop box",
                        iso));
    HuBone result;
    result.components = components.voxels.size();
    const Box room = room_around(components, surface.keep, hu);
    Box inner{};
    for (std::size_t a = 0; a < 3; ++a) {
        inner.first[a] = std::max(-room.first[a], 0);
        inner.last[a] = std::min(room.last[a], hu.size[a] - 1) - room.first[a];
    }
    Grid grey = cut_out(seen, room, air);
    smooth = {};
    result.bone.density = cut_out(hu, room, air);
    hu = {};
    close_border(grey, inner, iso);
    if (surface.keep > 0) keep_largest(grey, iso, moved_into(std::move(components), room), surface.keep);
    if (surface.fill) fill_hollows(grey, iso);
    result.bone.distance = distance_to_iso(grey, iso, run);
    for (float& value : result.bone.density.values) value = density_of_hu(value);
    result.bone.provenance["frame"] = "LPS";
    result.bone.provenance["calibration"] = density_calibration();
    result.bone.provenance["threshold"] = fmt::format("{} HU", iso);
    return result;
}

}  // namespace tactus
