// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/segmentation/segment_files.hpp"

#include "assets/bone/bone.hpp"
#include "assets/bone/import_steps.hpp"
#include "assets/bone/labels.hpp"
#include "assets/plan/case_plan.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_lock.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/plan_case.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::analysis {

namespace {

/// A bone's name in its file: there '#' divides the file's name from the bone's.
std::string bone_name_of(const SegmentedScan& found, std::size_t label) {
    std::string name = found.labels[label].name;
    std::ranges::replace(name, '#', '_');
    const auto is_taken = [&](const SegmentedLabel& other) { return other.name == name; };
    if (name == found.labels[label].name) return name;
    name += fmt::format(" ({})", label + 1);  // other names may differ by this character alone
    while (std::ranges::any_of(found.labels, is_taken)) name += '_';
    return name;
}

std::vector<volume::Segment> segments_of(const SegmentedScan& found) {
    std::vector<volume::Segment> segments;
    for (const SegmentedLabel& label : found.labels)
        segments.push_back({static_cast<int>(segments.size()) + 1, label.name, label.colour});
    return segments;
}

void write_bones(const ScanGraph& scan, const SegmentedScan& found, const SegmentSettings& settings,
                 const std::string& seeds, const std::filesystem::path& path) {
    volume::Grid labels{scan.scan.size, scan.scan.origin, scan.scan.spacing,
                        std::vector<float>(found.map.label.begin(), found.map.label.end())};
    bone::LabelBone how;
    // Scanner values are no densities.
    if (scan.hu != volume::HuKind::scanner) how.hu = &scan.scan;
    how.hu_is_masked = scan.hu == volume::HuKind::masked;
    bone::ImportOptions options;
    options.input = settings.scan;
    bone::ImportSummary summary;
    summary.frame = "LPS";
    summary.hu = volume::name_of(how.hu ? scan.hu : volume::HuKind::none);
    summary.notes = scan.notes;
    const std::string hash = bone::hash_of_source(settings.scan);
    std::vector<bone::Bone> bones;
    for (volume::Segment segment : segments_of(found)) {
        segment.name = bone_name_of(found, bones.size());
        bones.push_back(bone::bone_of_label(labels, segment, how, settings.run));
        bone::add_provenance(bones.back(), options, summary, hash);
        bones.back().provenance["seeds"] = seeds;
    }
    bone::save_bones(bones, path);
}

}  // namespace

void write_segmented(const ScanGraph& scan, const SegmentedScan& found, const SegmentSettings& settings,
                     const std::string& seeds, const std::filesystem::path& path) {
    if (path.extension() == ".vdb") write_bones(scan, found, settings, seeds, path);
    else volume::write_labels(scan.scan, found.map.label, segments_of(found), path);
}

void write_plan_of(const std::filesystem::path& bones, const SegmentedScan& found, const std::filesystem::path& plan,
                   const std::vector<reconstruction::FlapVessel>& vessels) {
    if (std::filesystem::exists(plan))
        throw Error(fmt::format("{}: the file exists already; a plan is never overwritten", plan.string()));
    const plan::PlanLock lock(plan);
    plan::CasePlan made;
    made.title = plan.stem().stem().string();
    for (std::size_t l = 0; l < found.labels.size(); ++l) {
        const SegmentedLabel& label = found.labels[l];
        plan::add_fragment(made, label.name, bones.string() + "#" + bone_name_of(found, l), plan.parent_path(),
                           label.colour);
        load_fragment(made.fragments.back(), plan.parent_path());
    }
    if (!vessels.empty()) {
        plan::PlanStep step;
        step.kind = plan::StepKind::vessels;
        step.by = "command";
        step.time = plan::time_of_day();
        step.vessels = std::make_shared<const std::vector<reconstruction::FlapVessel>>(vessels);
        plan::add_step(made, std::move(step));
    }
    plan::save_case_plan(made, plan);
}

}  // namespace tactus::analysis
