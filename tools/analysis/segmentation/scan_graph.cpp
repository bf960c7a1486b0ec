// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/ct_threshold.hpp"
#include "dsp/core/error.hpp"
#include "dsp/segmentation/gap_statistics.hpp"
#include "dsp/segmentation/propose_seeds.hpp"
#include "dsp/volume/value_range.hpp"
#include "tools/analysis/segmentation/segment_scan.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace tactus::analysis {

namespace {

constexpr std::size_t max_bone_voxels = 20'000'000;
constexpr double common_for_metal = 2500.0;  // HU

/// The samples from `low` to `high`, inclusive.
template <class Value>
std::vector<Value> part(const std::vector<Value>& values, const std::array<int, 3>& size, const std::array<int, 3>& low,
                        const std::array<int, 3>& high) {
    std::vector<Value> out;
    for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j) {
            const auto row = values.begin() + (static_cast<std::ptrdiff_t>(k) * size[1] + j) * size[0];
            out.insert(out.end(), row + low[0], row + high[0] + 1);
        }
    return out;
}

bool is_turned(const volume::ScanVolume& scan) {
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = glm::abs(scan.map.step[axis]);
        const double most = std::max({step.x, step.y, step.z});
        if (step.x + step.y + step.z - most > 2e-3 * most) return true;
    }
    return false;
}

}  // namespace

ScanGraph scan_graph(const SegmentSettings& settings) {
    const std::string file = settings.scan.string();
    volume::ScanVolume read = volume::read_volume(settings.scan, settings.read);
    if (const std::string question = volume::unit_question(read); !question.empty())
        throw Error(fmt::format("{}: {}", file, question));
    if (read.kind == volume::VolumeKind::labels)
        throw Error(fmt::format("{}: this is a label map; segment reads a CT", file));
    ScanGraph out;
    out.hu = read.hu;
    const std::optional<double> stated = read.surface_hu;
    out.notes = read.notes;
    if (is_turned(read))
        out.notes.push_back(
            "the axes of the scan are turned against the patient's; it was interpolated, and the labels are on axes "
            "along "
            "the patient");
    out.scan = volume::lps_grid(std::move(read));
    const volume::ValueRange range = volume::range_of(out.scan.values);
    out.is_in_hu = volume::are_hu(out.hu, static_cast<double>(range.high));
    if (settings.threshold) {
        out.threshold = *settings.threshold;
        out.threshold_from = "given";
    } else {
        volume::Histogram histogram =
            bone::threshold_histogram(static_cast<double>(range.low), static_cast<double>(range.high));
        volume::add_values(histogram, out.scan.values);
        const bone::CtThreshold found = bone::suggested_threshold(histogram, out.hu, stated);
        out.threshold = found.exact;
        out.threshold_from = found.how;
    }

    // Only in HU is the value of metal known.
    const double metal =
        settings.metal.value_or(out.is_in_hu ? common_for_metal : std::numeric_limits<double>::infinity());
    std::vector<std::uint8_t> inside(out.scan.count(), 0);
    std::array<int, 3> low = out.scan.size, high{-1, -1, -1};
    std::size_t v = 0, voxels = 0;
    for (int k = 0; k < out.scan.size[2]; ++k)
        for (int j = 0; j < out.scan.size[1]; ++j)
            for (int i = 0; i < out.scan.size[0]; ++i, ++v) {
                const double value = static_cast<double>(out.scan.values[v]);
                if (!(value >= out.threshold)) continue;
                if (value >= metal) {
                    ++out.metal_voxels;
                    continue;
                }
                inside[v] = 1;
                ++voxels;
                const std::array<int, 3> at{i, j, k};
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    low[axis] = std::min(low[axis], at[axis]);
                    high[axis] = std::max(high[axis], at[axis]);
                }
            }
    if (voxels == 0)
        throw Error(
            fmt::format("{}: there is no bone: no voxel reaches {:g}, the values are {:g} to {:g}; choose "
                        "--threshold",
                        file, out.threshold, static_cast<double>(range.low), static_cast<double>(range.high)));
    if (voxels > max_bone_voxels)
        throw Error(
            fmt::format("{}: {} voxels reach {:g}, more than {}; choose a higher --threshold, or a smaller part "
                        "of the scan",
                        file, voxels, out.threshold, max_bone_voxels));
    if (out.metal_voxels > 0)
        out.notes.push_back(
            fmt::format("{} voxels of {:g} or more are taken for metal and have no label", out.metal_voxels, metal));

    out.box = {{high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1},
               out.scan.position(low[0], low[1], low[2]),
               out.scan.spacing,
               part(out.scan.values, out.scan.size, low, high)};
    out.box_at = low;
    inside = part(inside, out.scan.size, low, high);
    out.law = segmentation::gap_law(segmentation::gap_statistics(out.box, inside));
    out.graph = segmentation::make_voxel_graph(out.box, inside, out.law);
    out.node_of_voxel = out.graph.node_of_voxel();
    return out;
}

std::vector<segmentation::SeedLabel> proposed_seeds(const ScanGraph& scan) {
    std::vector<segmentation::SeedLabel> labels;
    for (segmentation::ProposedFragment& fragment : segmentation::propose_seeds(scan.graph, scan.box, scan.law))
        labels.push_back({fmt::format("fragment_{}", labels.size() + 1), {}, std::move(fragment.strokes)});
    if (labels.size() < 2)
        throw Error(
            "no fragments are told apart: the bone is in one piece, or its pieces touch over too wide an area; write "
            "the "
            "seeds by hand");
    return labels;
}

}  // namespace tactus::analysis
