// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/ct_threshold.hpp"
#include "assets/bone/from_hu.hpp"
#include "assets/bone/import_steps.hpp"
#include "assets/volume/reoriented_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/volume/grid_part.hpp"
#include "dsp/volume/resample.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <set>
#include <utility>

namespace tactus::bone {

namespace {

constexpr double max_ct_voxels = 4e9;  // read in layers, never all in memory

double volume_mm3(const Vec3& spacing) { return spacing.x * spacing.y * spacing.z / (mm * mm * mm); }

struct Range {
    Vec3 low{-std::numeric_limits<double>::infinity()}, high{std::numeric_limits<double>::infinity()};  // m
};

Range parse_crop(const std::string& text) {
    Range range;
    if (text.empty()) return range;
    int read = 0;
    Vec3 &a = range.low, &b = range.high;
    const int found = std::sscanf(text.c_str(), "%lf:%lf,%lf:%lf,%lf:%lf%n", &a.x, &b.x, &a.y, &b.y, &a.z, &b.z, &read);
    if (found != 6 || read != static_cast<int>(text.size()) || !is_finite(a) || !is_finite(b) || a.x >= b.x ||
        a.y >= b.y || a.z >= b.z)
        throw Error(fmt::format("crop box '{}' is not x0:x1,y0:y1,z0:z1 in mm with x0 < x1, y0 < y1, z0 < z1", text));
    a *= mm;
    b *= mm;
    return range;
}

// Grid of the result: the samples of the file within the crop box, or a new grid with `spacing`.
volume::Grid ct_layout(const volume::Grid& ct, const Range& crop, std::optional<double> spacing) {
    volume::Grid layout{{}, {}, spacing ? Vec3(*spacing) : ct.spacing, {}};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double last = ct.origin[axis] + (ct.size[a] - 1) * ct.spacing[axis];
        double low = std::max(crop.low[axis], ct.origin[axis]);
        const double high = std::min(crop.high[axis], last);
        if (!spacing)
            low = ct.origin[axis] + std::ceil((low - ct.origin[axis]) / ct.spacing[axis] - 1e-9) * ct.spacing[axis];
        const double steps = std::floor((high - low) / layout.spacing[axis] + 1e-9);
        if (!(steps >= 2.0))
            throw Error(fmt::format("the crop box leaves no volume along {}: the file spans {:.1f} to {:.1f} mm there",
                                    "xyz"[axis], ct.origin[axis] / mm, last / mm));
        if (steps > 100000.0) throw Error("the spacing gives more than 100000 voxels along an axis; use a larger one");
        layout.origin[axis] = low;
        layout.size[a] = static_cast<int>(steps) + 1;
    }
    check_layout(layout, max_ct_voxels);
    return layout;
}

// "1 (femur), 2": the labels of a label map with their names.
std::string list_of_labels(const volume::ScanVolume& about, const volume::Tally& tally) {
    std::vector<std::string> words;
    // In the one map of overlapping segments some are hidden.
    std::set<int> labels = tally.labels;
    for (const volume::Segment& segment : about.segments) labels.insert(segment.label);
    for (const int label : labels) {
        if (label == 0) continue;
        const auto named = std::find_if(about.segments.begin(), about.segments.end(),
                                        [&](const volume::Segment& s) { return s.label == label && !s.name.empty(); });
        words.push_back(named == about.segments.end() ? std::to_string(label)
                                                      : fmt::format("{} ({})", label, named->name));
        if (words.size() == 12) break;
    }
    return words.empty() ? "it holds none"
                         : fmt::format("it holds {}{}", fmt::join(words, ", "), labels.size() > 13 ? ", ..." : "");
}

}  // namespace

void require_hu(volume::ScanVolume& about, const volume::Tally& tally, const ImportOptions& options,
                const std::filesystem::path& file) {
    if (options.rescale) about.hu = volume::HuKind::calibrated;
    if (volume::are_hu(about.hu, static_cast<double>(tally.high))) return;
    throw Error(
        fmt::format("{}: values {:g} to {:g} are not HU (no air near -1000). Calibrate them with two points VALUE:HU, "
                    "as in --hu-calibration 60:-1000,1100:40 (air and water or muscle), or state --rescale 1,0 if they "
                    "are HU of a part without air",
                    file.string(), tally.low + 0.0f, tally.high + 0.0f));
}

SparseImport import_ct(const ImportOptions& options, const ImportReport& report, ImportSummary& summary) {
    const Range crop = parse_crop(options.crop);
    const std::size_t keep = parse_component(options.component);
    report(0.0, "reading");
    const std::unique_ptr<volume::SliceReader> reader = open_scan(options.input, options, options.series);
    volume::ScanVolume& about = reader->about;
    volume::ReorientedVolume source(*reader, options.run);
    source.set_line(options.rescale);
    const auto check = [&] {
        source.settle();
        if (about.kind != volume::VolumeKind::ct && !options.rescale)
            throw Error(
                fmt::format("{}: this {} a label map, not a CT. Choose the bone with --label and its number or name, "
                            "or make one bone per label with --label all ({})",
                            options.input.string(), about.kind == volume::VolumeKind::labels ? "is" : "may be",
                            list_of_labels(about, source.tally())));
        require_hu(about, source.tally(), options, options.input);
    };
    if (source.is_turned()) check();
    const volume::Grid& ct = source.layout();
    const volume::Grid layout = ct_layout(ct, crop, options.spacing);
    // Without resampling, only the requested window is read.
    const bool same = ct.size == layout.size && ct.origin == layout.origin && ct.spacing == layout.spacing;
    const auto layers = [&](int first, int count, const HuLayers::Window& window) {
        if (same) return source.layers(first, count, {window.low, window.high});
        // Resampling works on whole layers, a few at a time.
        constexpr int at_once = 16;
        volume::Grid all;
        for (int k = first; k < first + count; k += at_once) {
            const volume::LayerRange wanted{k, std::min(at_once, first + count - k)},
                from = volume::layers_for(ct, layout, wanted);
            volume::Grid part = volume::window_of(
                volume::resampled_layers(source.layers(from.first, from.count), ct, layout, wanted, options.run),
                window.low, window.high);
            if (all.values.empty()) {
                all = std::move(part);
                all.values.reserve(static_cast<std::size_t>(count) * all.index(0, 0, 1));
                continue;
            }
            all.values.insert(all.values.end(), part.values.begin(), part.values.end());
            all.size[2] += part.size[2];
        }
        return all;
    };
    const HuLayers hu{layout, layers};
    CtThreshold threshold;
    if (options.threshold) {
        threshold = {*options.threshold, "given"};
    } else {
        check();
        threshold = suggested_threshold(threshold_histogram(source), about.hu,
                                        options.rescale ? std::nullopt : about.surface_hu);
        threshold.how = "suggested: " + threshold.how;
    }
    ImportInLayers how;
    how.at_once = options.layers_at_once;
    how.check_values = check;
    how.progress = [&](double share) {
        report(0.85 * share, share < 0.45 ? "reading and finding bone" : "surface and distance");
    };
    SparseHuBone made =
        sparse_bone_from_hu(hu, {static_cast<float>(threshold.value), keep, options.fill}, options.run, how);
    summary.hu = volume::name_of(about.hu);
    summary.notes = about.notes;
    summary.components = made.components;
    summary.components_kept = keep == 0 ? made.components : std::min(keep, made.components);
    const double voxel = volume_mm3(layout.spacing);
    summary.threshold.hu = threshold.value;
    summary.threshold.from = threshold.how;
    summary.threshold.above_mm3 = double(made.voxels_above) * voxel;
    summary.threshold.kept_mm3 = double(made.voxels_kept) * voxel;
    summary.hollow_mm3 = double(made.voxels_hollow) * voxel;
    summary.marrow_mm3 = double(made.voxels_marrow) * voxel;
    if (about.hu == volume::HuKind::masked)
        summary.threshold.mask_mm3 = double(source.tally().count - source.tally().zeros) * volume_mm3(about.spacing());
    SparseImport result{std::move(made.bone), {}};
    result.about.provenance = std::move(made.provenance);
    auto& provenance = result.about.provenance;
    provenance["threshold_from"] = threshold.how;
    provenance["encoding"] = about.encoding;
    provenance["file_frame"] = volume::name_of(about.file_frame);
    if (source.is_turned()) provenance["axes"] = "turned; resampled to LPS";
    if (options.rescale)
        provenance["rescale"] = fmt::format("HU = {} * value + {}", options.rescale->first, options.rescale->second);
    return result;
}

}  // namespace tactus::bone
