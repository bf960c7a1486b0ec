// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/from_hu.hpp"

#include "assets/bone/air_around.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/volume/compact_slice.hpp"
#include "dsp/volume/components.hpp"
#include "dsp/volume/grid_part.hpp"
#include "dsp/volume/iso_distance.hpp"
#include "dsp/volume/marrow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace tactus::bone {

namespace {

constexpr int margin = 4;
constexpr float air_hu = -300.0f;  // below fat and above lungs
constexpr double density_slope = 1.067, density_offset = 131.0;

using Box = volume::Components::Box;

// Margin of air around the bone, in samples along each axis.
std::array<int, 3> reach_of(const Vec3& spacing) {
    std::array<int, 3> reach{};
    for (int axis = 0; axis < 3; ++axis)
        reach[static_cast<std::size_t>(axis)] = 6 + static_cast<int>(std::ceil(air_around / spacing[axis]));
    return reach;
}

// Box around the kept components with a margin of air; outside the volume only four layers, enough to close the bone
// where the scan ends.
Box room_around(const volume::Components& components, std::size_t keep, const volume::Grid& layout) {
    Box room = components.boxes.front();
    for (std::size_t n = 1; n < components.boxes.size() && (keep == 0 || n < keep); ++n)
        for (std::size_t a = 0; a < 3; ++a) {
            room.first[a] = std::min(room.first[a], components.boxes[n].first[a]);
            room.last[a] = std::max(room.last[a], components.boxes[n].last[a]);
        }
    const std::array<int, 3> reach = reach_of(layout.spacing);
    for (std::size_t a = 0; a < 3; ++a) {
        room.first[a] = std::max(room.first[a] - reach[a], -margin);
        room.last[a] = std::min(room.last[a] + reach[a], layout.size[a] - 1 + margin);
    }
    return room;
}

// The same runs, counted from the first sample of the box; parts outside of it are dropped.
volume::Components moved_into(const volume::Components& components, const Box& room) {
    volume::Components moved;
    volume::RunRows& rows = moved.rows;
    for (std::size_t a = 0; a < 3; ++a) rows.size[a] = room.last[a] - room.first[a] + 1;
    const auto& from = components.rows;
    for (int k = room.first[2]; k <= room.last[2]; ++k) {
        leave_if_stopped();
        for (int j = room.first[1]; j <= room.last[1]; ++j) {
            if (j >= 0 && k >= 0 && j < from.size[1] && k < from.size[2])
                for (volume::SampleRun run : from.row(j, k)) {
                    run.begin = std::max(run.begin, room.first[0]) - room.first[0];
                    run.end = std::min(run.end, room.last[0] + 1) - room.first[0];
                    if (run.begin < run.end) rows.runs.push_back(run);
                }
            rows.start.push_back(rows.runs.size());
        }
    }
    return moved;
}

// Marrow of the kept components, in samples of the box.
volume::RunRows marrow_in(const volume::Components& components, std::size_t keep, const volume::RunRows& hollows,
                          const volume::Components& air, const Box& box, const volume::Grid& layout) {
    volume::RunRows kept{components.rows.size, {0}, {}};
    for (int k = 0; k < kept.size[2]; ++k)
        for (int j = 0; j < kept.size[1]; ++j) {
            for (const volume::SampleRun& run : components.rows.row(j, k))
                if (keep == 0 || static_cast<std::size_t>(run.part) < keep) kept.runs.push_back(run);
            kept.start.push_back(kept.runs.size());
        }
    Box inner{};
    for (std::size_t a = 0; a < 3; ++a) {
        inner.first[a] = std::max(0, -box.first[a]);
        inner.last[a] = std::min(box.last[a], layout.size[a] - 1) - box.first[a];
    }
    return volume::marrow_of(volume::united(kept, hollows), air.rows, inner, layout.spacing);
}

int smoothing_passes(const Vec3& spacing) {
    const double voxel = std::max({spacing.x, spacing.y, spacing.z}), wanted = 0.3e-3;
    return static_cast<int>(std::clamp(std::floor(3.0 * wanted * wanted / (voxel * voxel)), 0.0, 3.0));
}

// Samples of a layer that are processed at a time; with their neighbourhood they need about 25 bytes each.
constexpr std::size_t samples_at_once = std::size_t{8} << 20;

int layers_at_once(const volume::Grid& layout) {
    const std::size_t layer = layout.index(0, 0, 1), wanted = samples_at_once / std::max<std::size_t>(layer, 1);
    const auto layers = static_cast<std::size_t>(layout.size[2]), most = std::clamp<std::size_t>(wanted, 1, layers);
    const std::size_t slabs = (layers + most - 1) / most, each = (layers + slabs - 1) / slabs;
    return SparseBone::side * static_cast<int>((each + SparseBone::side - 1) / SparseBone::side);
}

struct Source {
    const HuLayers& hu;
    float iso;
    int passes;
    const RunJobs& run;

    int layers() const { return hu.layout.size[2]; }

    // A box in x and y with the margin that smoothing needs, so that its samples get the same bits as when the whole
    // layer is smoothed.
    void widen(std::array<int, 2>& low, std::array<int, 2>& high) const {
        for (std::size_t a = 0; a < 2; ++a) {
            low[a] = std::max(low[a] - 2 * passes - 1, 0);
            high[a] = std::min(high[a] + 2 * passes + 1, hu.layout.size[a] - 1);
        }
    }

    volume::Grid smooth(volume::Grid slab) const {
        for (int pass = 0; pass < passes; ++pass) slab = volume::smoothed(std::move(slab), run);
        return slab;
    }

    // Bounding box in x and y of the samples of a slab that reach iso; high < low when none does.
    void box_of(const volume::Grid& slab, std::array<int, 2>& low, std::array<int, 2>& high) const {
        std::vector<std::array<int, 4>> boxes(static_cast<std::size_t>(slab.size[2]));
        run(slab.size[2], [&](int k) {
            std::array<int, 4>& box = boxes[static_cast<std::size_t>(k)];
            box = {slab.size[0], slab.size[1], -1, -1};
            for (int j = 0; j < slab.size[1]; ++j) {
                const float* row = &slab.values[slab.index(0, j, k)];
                const float* end = row + slab.size[0];
                const float* first = std::find_if(row, end, [this](float v) { return v >= iso; });
                if (first == end) continue;
                const float* last = end - 1;
                while (!(*last >= iso)) --last;
                box = {std::min(box[0], static_cast<int>(first - row)), std::min(box[1], j),
                       std::max(box[2], static_cast<int>(last - row)), j};
            }
        });
        low = {slab.size[0], slab.size[1]}, high = {-1, -1};
        for (const auto& box : boxes)
            for (std::size_t a = 0; a < 2; ++a) {
                low[a] = std::min(low[a], box[a]);
                high[a] = std::max(high[a], box[a + 2]);
            }
    }

    // The smoothed samples that reach iso, over the whole volume, and those of air.
    std::pair<volume::RunRows, volume::RunRows> runs(int at_once, const ImportInLayers& how) const {
        volume::RunRows rows{hu.layout.size, {0}, {}}, air = rows;
        for (int k = 0; k < layers(); k += at_once) {
            const int count = std::min(at_once, layers() - k), below = std::min(passes, k);
            volume::Grid slab = hu.layers(k - below, std::min(count + below + passes, layers() - k + below),
                                          {{0, 0}, {hu.layout.size[0] - 1, hu.layout.size[1] - 1}});
            std::array<int, 2> low{}, high{};
            if (passes > 0) box_of(slab, low, high);
            if (passes > 0 && high[0] >= 0) {
                widen(low, high);
                const volume::Grid part = smooth(volume::window_of(slab, low, high));
                for (int z = 0; z < part.size[2]; ++z)
                    for (int y = 0; y < part.size[1]; ++y)
                        std::copy_n(&part.values[part.index(0, y, z)], part.size[0],
                                    &slab.values[slab.index(low[0], low[1] + y, z)]);
            }
            volume::append_above(rows, slab, iso, below, count, run);
            for (float& value : slab.values) value = -value;
            volume::append_above(air, slab, -air_hu, below, count, run);
            how.progress(0.45 * (k + count) / layers());
        }
        return {std::move(rows), std::move(air)};
    }
};

// Grey values and HU of the layers of the box around a bone, computed on request.
struct Room {
    const Source& source;
    const Box& box;
    const volume::Components& components;  // in samples of the box, like the hollows
    const volume::RunRows& hollows;
    std::size_t keep;
    std::map<int, volume::CompactSlice> hu{};  // by layer of the box, inside the volume

    // Range of the box that lies in the volume, in samples along each axis.
    std::array<int, 3> inner_first() const {
        return {std::max(box.first[0], 0), std::max(box.first[1], 0), std::max(box.first[2], 0)};
    }
    std::array<int, 3> inner_last() const {
        const auto& size = source.hu.layout.size;
        return {std::min(box.last[0], size[0] - 1), std::min(box.last[1], size[1] - 1),
                std::min(box.last[2], size[2] - 1)};
    }

    volume::Grid layout() const {
        const volume::Grid& all = source.hu.layout;
        volume::Grid room{{}, all.position(box.first[0], box.first[1], box.first[2]), all.spacing, {}};
        for (std::size_t a = 0; a < 3; ++a) room.size[a] = box.last[a] - box.first[a] + 1;
        return room;
    }

    // Values outside the volume: border samples at or above iso are mirrored about iso, which puts the closing face
    // half a voxel outside.
    float beyond(float edge) const {
        return edge >= source.iso ? std::min(2.0f * source.iso - edge, source.iso - 1.0f) : edge;
    }

    volume::Grid grey(int first, int count) {
        const int last_layer = source.layers() - 1, passes = source.passes;
        const int a = std::clamp(first + box.first[2], 0, last_layer),
                  b = std::clamp(first + count - 1 + box.first[2], 0, last_layer);
        const int below = std::min(passes, a), above = std::min(passes, last_layer - b);
        const std::array<int, 3> inner = inner_first(), inner_end = inner_last();
        std::array<int, 2> low{inner[0], inner[1]}, high{inner_end[0], inner_end[1]};
        source.widen(low, high);
        volume::Grid part = source.hu.layers(a - below, b - a + 1 + below + above, {low, high});
        const std::array<int, 2> at{inner[0] - low[0], inner[1] - low[1]};
        remember(part, at, first, count, a - below);
        part = source.smooth(std::move(part));

        volume::Grid out = layout();
        out.size[2] = count;
        out.values.resize(out.count());
        const std::array<int, 2> to{inner_end[0] - low[0], inner_end[1] - low[1]};
        source.run(count, [&](int n) {
            const int z = first + n + box.first[2];
            const bool in_z = z >= 0 && z <= last_layer;
            const int from = std::clamp(z, 0, last_layer) - (a - below);
            for (int j = 0; j < out.size[1]; ++j) {
                const int y = std::clamp(j + box.first[1] - low[1], at[1], to[1]);
                const bool in_y = y == j + box.first[1] - low[1];
                const float* row = &part.values[part.index(0, y, from)];
                float* into = &out.values[out.index(0, j, n)];
                for (int i = 0; i < out.size[0]; ++i) {
                    const int x = std::clamp(i + box.first[0] - low[0], at[0], to[0]);
                    const bool in = in_z && in_y && x == i + box.first[0] - low[0];
                    into[i] = in ? row[x] : beyond(row[x]);
                }
            }
        });
        if (keep > 0) volume::keep_largest(out, source.iso, components, keep, first);
        volume::fill_hollows(out, source.iso, hollows, first);
        return out;
    }

    // Stores the HU of new layers until their density is computed.
    void remember(const volume::Grid& part, const std::array<int, 2>& at, int first, int count, int part_first) {
        const std::array<int, 3> inner = inner_first(), inner_end = inner_last();
        std::vector<float> values;
        for (int n = first; n < first + count; ++n) {
            const int z = n + box.first[2];
            if (z < inner[2] || z > inner_end[2]) continue;
            leave_if_stopped();
            values.clear();
            for (int j = 0; j <= inner_end[1] - inner[1]; ++j) {
                const float* row = &part.values[part.index(at[0], at[1] + j, z - part_first)];
                values.insert(values.end(), row, row + (inner_end[0] - inner[0] + 1));
            }
            hu[n] = volume::CompactSlice(values);
        }
    }

    // Density of layers whose grey values are computed; then frees their HU.
    volume::Grid density(int first, int count) {
        volume::Grid out = layout();
        out.size[2] = count;
        out.values.assign(out.count(), 0.0f);
        const std::array<int, 3> inner = inner_first(), inner_end = inner_last();
        const auto width = static_cast<std::size_t>(inner_end[0] - inner[0] + 1);
        source.run(count, [&](int n) {
            const auto found = hu.find(first + n);
            if (found == hu.end()) return;
            for (int y = inner[1]; y <= inner_end[1]; ++y) {
                float* row = &out.values[out.index(inner[0] - box.first[0], y - box.first[1], n)];
                found->second.copy(static_cast<std::size_t>(y - inner[1]) * width, {row, width});
                for (std::size_t i = 0; i < width; ++i) row[i] = density_of_hu(row[i]);
            }
        });
        hu.erase(hu.begin(), hu.lower_bound(first + count));
        return out;
    }
};

}  // namespace

float density_of_hu(float hu) {
    return std::max(0.0f, static_cast<float>(density_slope * static_cast<double>(hu) + density_offset));
}

float hu_of_density(float density) {
    return static_cast<float>((static_cast<double>(density) - density_offset) / density_slope);
}

std::string density_calibration() {
    return fmt::format(
        "from HU, without a density phantom in the scan: density = {} * HU + {} kg/m3 (mg/cm3), at least 0; line of "
        "Rho, Hobatho and Ashman 1995",
        density_slope, density_offset);
}

SparseHuBone sparse_bone_from_hu(const HuLayers& hu, const BoneSurface& surface, const RunJobs& run,
                                 const ImportInLayers& how) {
    const float iso = surface.threshold;
    const Source source{hu, iso, smoothing_passes(hu.layout.spacing), run};
    auto [rows, air] = source.runs(how.at_once > 0 ? how.at_once : layers_at_once(hu.layout), how);
    how.check_values();
    volume::Components found = volume::components_of(std::move(rows));
    if (found.voxels.empty())
        throw Error(
            fmt::format("nothing in the volume reaches {} HU, so there is no bone; lower the threshold or move "
                        "the crop box",
                        iso));
    SparseHuBone result;
    result.components = found.voxels.size();
    for (std::size_t n = 0; n < found.voxels.size(); ++n) {
        result.voxels_above += found.voxels[n];
        if (surface.keep == 0 || n < surface.keep) result.voxels_kept += found.voxels[n];
    }
    const Box box = room_around(found, surface.keep, hu.layout);
    const volume::Components components = moved_into(std::exchange(found, {}), box);
    const volume::RunRows no_hollows{
        components.rows.size, std::vector<std::size_t>(components.rows.start.size(), 0), {}};
    volume::RunRows hollows = surface.fill ? volume::hollows_of(components, surface.keep) : no_hollows;
    result.voxels_hollow = volume::count_of(hollows);
    if (surface.fill) {
        const volume::RunRows marrow =
            marrow_in(components, surface.keep, hollows, moved_into({std::move(air), {}, {}}, box), box, hu.layout);
        result.voxels_marrow = volume::count_of(marrow);
        hollows = volume::united(hollows, marrow);
    }
    Room room{source, box, components, hollows, surface.keep};
    const Vec3& h = hu.layout.spacing;
    const double reach = std::max(air_around, 6.0 * std::max({h.x, h.y, h.z}));
    result.bone = SparseBone(room.layout(), static_cast<float>(reach));
    const volume::Grid layout = room.layout();
    const int at_once = how.at_once > 0 ? (how.at_once + SparseBone::side - 1) / SparseBone::side * SparseBone::side
                                        : layers_at_once(layout);
    volume::distance_to_iso(
        layout, iso, {reach, at_once}, [&](int first, int count) { return room.grey(first, count); },
        [&](int first, const volume::Grid& distance) {
            result.bone.add_layers(first, distance, room.density(first, distance.size[2]), run);
            how.progress(0.45 + 0.55 * (first + distance.size[2]) / layout.size[2]);
        },
        run);
    result.provenance["frame"] = "LPS";
    result.provenance["calibration"] = density_calibration();
    result.provenance["threshold"] = fmt::format("{} HU", iso);
    return result;
}

HuBone bone_from_hu(volume::Grid hu, const BoneSurface& surface, const RunJobs& run) {
    const volume::Grid layout{hu.size, hu.origin, hu.spacing, {}};
    const auto layers = [&hu](int first, int count, const HuLayers::Window& window) {
        volume::Grid all{{hu.size[0], hu.size[1], count}, hu.position(0, 0, first), hu.spacing, {}};
        all.values.assign(hu.values.begin() + static_cast<std::ptrdiff_t>(hu.index(0, 0, first)),
                          hu.values.begin() + static_cast<std::ptrdiff_t>(hu.index(0, 0, first + count)));
        return volume::window_of(all, window.low, window.high);
    };
    SparseHuBone made = sparse_bone_from_hu({layout, layers}, surface, run);
    HuBone result{dense_of(made.bone), made.components};
    result.bone.provenance = std::move(made.provenance);
    return result;
}

}  // namespace tactus::bone
