// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/from_hu.hpp"
#include "assets/bone/import_steps.hpp"
#include "dsp/core/error.hpp"
#include "dsp/distance/resample.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>
#include <utility>

namespace tactus {

namespace {

constexpr double mm = 1e-3;

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

// Samples of the result: the file's own within the box, or new ones at `spacing`.
Grid ct_layout(const Grid& ct, const Range& crop, std::optional<double> spacing) {
    Grid layout{{}, {}, spacing ? Vec3(*spacing) : ct.spacing, {}};
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
    check_layout(layout);
    return layout;
}

// "1 (femur), 2": what the structures of a label map are called.
std::string list_of_labels(const ScanVolume& volume) {
    std::set<int> found;
    for (const float value : volume.values)
        if (value > 0.0f && value <= 65535.0f) found.insert(static_cast<int>(value));
    std::vector<std::string> words;
    for (const int label : found) {
        const auto named = std::find_if(volume.segments.begin(), volume.segments.end(),
                                        [&](const Segment& s) { return s.label == label && !s.name.empty(); });
        words.push_back(named == volume.segments.end() ? std::to_string(label)
                                                       : fmt::format("{} ({})", label, named->name));
        if (words.size() == 12) break;
    }
    return words.empty() ? "it holds none"
                         : fmt::format("it holds {}{}", fmt::join(words, ", "), found.size() > 12 ? ", ..." : "");
}

}  // namespace

void require_hu(ScanVolume& volume, const ImportOptions& options, const std::filesystem::path& file) {
    if (options.rescale) {
        for (float& value : volume.values)
            value = static_cast<float>(options.rescale->first * double(value) + options.rescale->second);
        volume.hu = HuKind::calibrated;
    }
    if (volume.hu != HuKind::scanner) return;
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    throw Error(
        fmt::format("{}: values {:g} to {:g} are not HU (no air near -1000): scanner numbers. Say which of them are "
                    "which HU, as in --hu-calibration 60:-1000,1100:40 (air and water or muscle), or convert the "
                    "file first",
                    file.string(), *low, *high));
}

Bone import_ct(const ImportOptions& options, const ImportReport& report, ImportSummary& summary) {
    const Range crop = parse_crop(options.crop);
    const std::size_t keep = parse_component(options.component);
    report(0.0, "reading");
    ScanVolume volume = read_volume(options.input, {options.series});
    if (volume.kind == VolumeKind::labels && !options.rescale)
        throw Error(
            fmt::format("{}: a label map, not a CT: its values are numbers of structures. Say which of them is the "
                        "bone with --label N or its name, or --label all for one bone each ({})",
                        options.input.string(), list_of_labels(volume)));
    require_hu(volume, options, options.input);
    summary.hu = name_of(volume.hu);
    summary.notes = volume.notes;
    const Frame file_frame = volume.file_frame;
    const std::string encoding = volume.encoding;
    const bool turned = is_turned(volume);
    Grid ct = lps_grid(std::move(volume));
    const Grid layout = ct_layout(ct, crop, options.spacing);
    report(0.2, "resampling");
    Grid hu = resampled(std::move(ct), layout);
    report(0.4, "surface and distance");
    HuBone made = bone_from_hu(std::move(hu), {static_cast<float>(options.threshold), keep, options.fill}, options.run);
    summary.components = made.components;
    made.bone.provenance["encoding"] = encoding;
    made.bone.provenance["file_frame"] = name_of(file_frame);
    if (turned) made.bone.provenance["axes"] = "turned; resampled to LPS";
    if (options.rescale)
        made.bone.provenance["rescale"] =
            fmt::format("HU = {} * value + {}", options.rescale->first, options.rescale->second);
    return std::move(made.bone);
}

}  // namespace tactus
