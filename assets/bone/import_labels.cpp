// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/air_around.hpp"
#include "assets/bone/import_steps.hpp"
#include "assets/bone/labels.hpp"
#include "assets/volume/reoriented_volume.hpp"
#include "dsp/core/error.hpp"
#include "dsp/volume/components.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

namespace tactus::bone {

namespace {

// The labels that `wanted` selects: "all", a number, or a name from the file.
std::vector<volume::Segment> choose_segments(const std::string& wanted, const std::vector<int>& labels,
                                             const std::vector<volume::Segment>& named, const std::string& file) {
    if (labels.empty()) throw Error(fmt::format("{}: every voxel is 0; there is no label", file));
    std::vector<volume::Segment> all;
    std::vector<std::string> names;
    for (const int label : labels) {
        const auto known =
            std::find_if(named.begin(), named.end(), [&](const volume::Segment& s) { return s.label == label; });
        all.push_back(known != named.end() ? *known : volume::Segment{label, "", {}});
        // Names must be unique: a second label of the same name gets its number.
        if (all.back().name.empty() || std::count(names.begin(), names.end(), all.back().name) > 0)
            all.back().name = fmt::format("label_{}", label);
        names.push_back(all.back().name);
    }
    if (wanted == "all") return all;
    for (const volume::Segment& segment : all)
        if (wanted == std::to_string(segment.label) || wanted == segment.name) return {segment};
    throw Error(fmt::format("{}: there is no label '{}'; there are {}{}", file, wanted, fmt::join(labels, ", "),
                            did_you_mean(wanted, names)));
}

std::size_t pieces_of(volume::Grid distance) {
    for (float& value : distance.values) value = -value;
    return volume::components_above(distance, 0.0f).voxels.size();
}

/// Leaves the `keep` largest parts of the label, and returns how many it had.
std::size_t keep_parts(volume::Grid& map, int label, std::size_t keep) {
    volume::Grid inside{map.size, map.origin, map.spacing, {}};
    inside.values.reserve(map.values.size());
    for (const float value : map.values) inside.values.push_back(value == static_cast<float>(label) ? 1.0f : 0.0f);
    const volume::Components parts = volume::components_above(inside, 0.5f);
    for (int k = 0; k < map.size[2]; ++k)
        for (int j = 0; j < map.size[1]; ++j)
            for (const volume::SampleRun& run : parts.rows.row(j, k))
                if (static_cast<std::size_t>(run.part) >= keep)
                    for (int i = run.begin; i < run.end; ++i) map.at(i, j, k) = 0.0f;
    return parts.voxels.size();
}

// Bounding box of each label, in samples.
std::map<int, volume::Components::Box> boxes_of(volume::ReorientedVolume& source) {
    constexpr int at_once = 16;
    const auto& size = source.layout().size;
    std::map<int, volume::Components::Box> boxes;
    for (int k = 0; k < size[2]; k += at_once) {
        const volume::Grid slab = source.layers(k, std::min(at_once, size[2] - k));
        int last = 0;
        volume::Components::Box* box = nullptr;
        for (int z = 0; z < slab.size[2]; ++z)
            for (int y = 0; y < slab.size[1]; ++y)
                for (int x = 0; x < slab.size[0]; ++x) {
                    const float value = slab.at(x, y, z);
                    // Invalid values are reported after the whole map is read.
                    if (!(value > 0.0f && value <= 65535.0f) || boxes.size() > 1000) continue;
                    const std::array<int, 3> at{x, y, k + z};
                    if (const int label = static_cast<int>(value); label != last || !box) {
                        box = &boxes.insert({label, {at, at}}).first->second;
                        last = label;
                    }
                    for (std::size_t a = 0; a < 3; ++a) {
                        box->first[a] = std::min(box->first[a], at[a]);
                        box->last[a] = std::max(box->last[a], at[a]);
                    }
                }
    }
    return boxes;
}

// All labels of the map, ascending. Throws Error when the values are not labels.
std::vector<int> labels_of(const volume::Tally& tally, const std::string& file) {
    if (!tally.whole)
        throw Error(
            fmt::format("{}: values of {:g} to {:g} are not labels: labels are whole numbers from 0 to 65535; for a CT "
                        "leave out --label",
                        file, tally.low, tally.high));
    if (tally.labels.size() > 1000)
        throw Error(fmt::format(
            "{}: more than 1000 different values: this is an image, not a label map; leave out --label", file));
    std::vector<int> labels(tally.labels.begin(), tally.labels.end());
    std::erase(labels, 0);
    return labels;
}

// The part of `source` around `box` (in samples of `layout`), with the margin of air plus `more` samples.
volume::Grid part_around(volume::ReorientedVolume& source, const volume::Grid& layout,
                         const volume::Components::Box& box, int more) {
    const volume::Grid& all = source.layout();
    std::array<int, 3> low{}, high{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double air = air_around + (7.0 + more) * std::max(layout.spacing[axis], all.spacing[axis]);
        const double from = layout.origin[axis] + box.first[a] * layout.spacing[axis] - air - all.origin[axis];
        const double to = layout.origin[axis] + box.last[a] * layout.spacing[axis] + air - all.origin[axis];
        low[a] = std::clamp(static_cast<int>(std::floor(from / all.spacing[axis])), 0, all.size[a] - 1);
        high[a] = std::clamp(static_cast<int>(std::ceil(to / all.spacing[axis])), low[a], all.size[a] - 1);
    }
    return volume::part_of(source, low, high);
}

/// One layer of a label map; a map without layers is one.
struct LabelLayer {
    int layer;
    std::unique_ptr<volume::ReorientedVolume> source;
    std::map<int, volume::Components::Box> boxes;
};

LabelLayer read_labels(volume::SliceReader& reader, int layer, const RunJobs& run) {
    reader.show_layer(layer);
    LabelLayer made{layer, std::make_unique<volume::ReorientedVolume>(reader, run), {}};
    reader.about.kind = volume::VolumeKind::labels;
    if (made.source->is_turned()) made.source->settle();
    made.boxes = boxes_of(*made.source);
    made.source->settle();
    return made;
}

}  // namespace

std::vector<ImportedBone> import_labels(const ImportOptions& options, const ImportProgress& progress) {
    check_options(options);
    if (!options.crop.empty()) throw Error("--crop is for CT volumes; in a label map the bones are separated already");
    const std::size_t keep = parse_component(options.component, 0);
    const ImportReport report{progress};
    const std::string file = options.input.string();
    report(0.0, "reading");
    const std::unique_ptr<volume::SliceReader> reader = open_scan(options.input, options, options.series);
    const std::vector<std::string> notes = reader->about.notes;
    // Overlapping segments lie in layers: each is read from its own, so that none loses voxels to another.
    std::vector<LabelLayer> layers;
    std::vector<int> labels;
    for (int layer = 0; layer < reader->layer_count(); ++layer) {
        layers.push_back(read_labels(*reader, layer, options.run));
        const std::vector<int> found = labels_of(layers.back().source->tally(), file);
        labels.insert(labels.end(), found.begin(), found.end());
    }
    std::ranges::sort(labels);
    const std::vector<volume::Segment> chosen = choose_segments(options.label, labels, reader->about.segments, file);
    std::vector<std::string> empty;
    for (const volume::Segment& segment : reader->about.segments)
        if (!std::ranges::binary_search(labels, segment.label))
            empty.push_back(segment.name.empty() ? fmt::format("label {}", segment.label) : segment.name);
    LabelBone how;
    how.spacing = options.spacing;
    // One label of many: maps of whole bodies have muscles and organs around it.
    how.keeps_border = chosen.size() > 1;
    std::unique_ptr<volume::SliceReader> grey;
    std::optional<volume::ReorientedVolume> ct;
    volume::HuKind hu = volume::HuKind::none;
    if (!options.ct.empty()) {
        grey = open_scan(options.ct, options, "");
        ct.emplace(*grey, options.run);
        ct->set_line(options.rescale);
        ct->settle();
        require_hu(grey->about, ct->tally(), options, options.ct);
        hu = grey->about.hu;
        how.hu_is_masked = hu == volume::HuKind::masked;
    }
    const std::string source_hash = hash_of_source(options.input);
    // What reading the values added, as of voxels that are not numbers.
    std::vector<std::string> settled;
    for (std::size_t n = notes.size(); n < reader->about.notes.size(); ++n)
        if (std::ranges::find(settled, reader->about.notes[n]) == settled.end())
            settled.push_back(reader->about.notes[n]);
    std::vector<ImportedBone> bones;
    for (const volume::Segment& segment : chosen) {
        report(0.1 + 0.9 * static_cast<double>(bones.size()) / static_cast<double>(chosen.size()), segment.name);
        // One label at a time is in memory.
        const auto of_label =
            std::ranges::find_if(layers, [&](const LabelLayer& each) { return each.boxes.contains(segment.label); });
        reader->show_layer(of_label->layer);
        volume::ReorientedVolume& source = *of_label->source;
        const volume::Components::Box& box = of_label->boxes.at(segment.label);
        volume::Grid map = part_around(source, source.layout(), box, 0);
        const std::size_t parts = keep > 0 ? keep_parts(map, segment.label, keep) : 0;
        const volume::Grid values = ct ? part_around(*ct, source.layout(), box, 4) : volume::Grid{};
        how.hu = ct ? &values : nullptr;
        ImportedBone made;
        made.bone = bone_of_label(map, segment, how, options.run);
        made.summary.hu = volume::name_of(hu);
        made.summary.notes = notes;
        made.summary.notes.insert(made.summary.notes.end(), settled.begin(), settled.end());
        if (!empty.empty())
            made.summary.notes.push_back(fmt::format("of {} named segments {} have no voxels: {}",
                                                     reader->about.segments.size(), empty.size(),
                                                     fmt::join(empty, ", ")));
        made.summary.components = keep > 0 ? parts : pieces_of(made.bone.distance);
        made.summary.components_kept = keep > 0 ? std::min(keep, made.summary.components) : made.summary.components;
        measure(made.bone, made.summary);
        add_points(made.bone, options, made.summary);
        add_provenance(made.bone, options, made.summary, source_hash);
        if (keep > 0) made.bone.provenance["component"] = options.component;
        if (!options.ct.empty()) made.bone.provenance["ct"] = options.ct.filename().string();
        bones.push_back(std::move(made));
    }
    report(1.0, "done");
    return bones;
}

}  // namespace tactus::bone
