// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/import_steps.hpp"
#include "assets/bone/labels.hpp"
#include "dsp/core/error.hpp"
#include "dsp/distance/components.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tactus {

namespace {

// Those of the map that `wanted` means: "all", a number, or a name that the file gives.
std::vector<Segment> choose_segments(const std::string& wanted, const std::vector<int>& labels,
                                     const std::vector<Segment>& named, const std::string& file) {
    if (labels.empty()) throw Error(fmt::format("{}: every voxel is 0; there is no label", file));
    std::vector<Segment> all;
    std::vector<std::string> names;
    for (const int label : labels) {
        const auto known = std::find_if(named.begin(), named.end(), [&](const Segment& s) { return s.label == label; });
        all.push_back(known != named.end() ? *known : Segment{label, "", {}});
        // A name that another label has already would not tell them apart.
        if (all.back().name.empty() || std::count(names.begin(), names.end(), all.back().name) > 0)
            all.back().name = fmt::format("label {}", label);
        names.push_back(all.back().name);
    }
    if (wanted == "all") return all;
    for (const Segment& segment : all)
        if (wanted == std::to_string(segment.label) || wanted == segment.name) return {segment};
    throw Error(fmt::format("{}: has no label '{}' but {}{}", file, wanted, fmt::join(labels, ", "),
                            did_you_mean(wanted, names)));
}

std::size_t pieces_of(Grid distance) {
    for (float& value : distance.values) value = -value;
    return components_above(distance, 0.0f).voxels.size();
}

}  // namespace

std::vector<ImportedBone> import_labels(const ImportOptions& options, const ImportProgress& progress) {
    check_options(options);
    if (!options.crop.empty()) throw Error("a crop box is for CT volumes; a label map's bones are cut out already");
    const ImportReport report{progress};
    report(0.0, "reading");
    ScanVolume volume = read_volume(options.input, {options.series});
    volume.kind = VolumeKind::labels;
    const std::vector<Segment> named = volume.segments;
    const std::vector<std::string> notes = volume.notes;
    const Grid map = lps_grid(std::move(volume));
    const std::vector<Segment> chosen = choose_segments(options.label, labels_in(map), named, options.input.string());
    LabelBone how;
    how.spacing = options.spacing;
    Grid ct;
    HuKind hu = HuKind::none;
    if (!options.ct.empty()) {
        ScanVolume grey = read_volume(options.ct);
        require_hu(grey, options, options.ct);
        hu = grey.hu;
        ct = lps_grid(std::move(grey));
        how.hu = &ct;
        how.hu_is_masked = hu == HuKind::masked;
    }
    const std::string source_hash = hash_of_source(options.input);
    std::vector<ImportedBone> bones;
    for (const Segment& segment : chosen) {
        report(0.1 + 0.9 * static_cast<double>(bones.size()) / static_cast<double>(chosen.size()), segment.name);
        ImportedBone made;
        made.bone = bone_of_label(map, segment, how, options.run);
        made.summary.hu = name_of(hu);
        made.summary.notes = notes;
        made.summary.components = pieces_of(made.bone.distance);
        measure(made.bone, made.summary);
        add_points(made.bone, options, made.summary);
        add_provenance(made.bone, options, made.summary, source_hash);
        if (!options.ct.empty()) made.bone.provenance["ct"] = options.ct.filename().string();
        bones.push_back(std::move(made));
    }
    report(1.0, "done");
    return bones;
}

}  // namespace tactus
