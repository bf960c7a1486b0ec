// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/import.hpp"

#include "assets/bone/import_steps.hpp"
#include "assets/bone/mesh_part.hpp"
#include "dsp/core/stop.hpp"

#include <utility>

namespace tactus::bone {

namespace {

// "jaw" of jaw.nii.gz and of the folder jaw/.
std::string bone_name(const std::filesystem::path& input) {
    const std::filesystem::path last = input.filename().empty() ? input.parent_path().filename() : input.filename();
    return (last.extension() == ".gz" ? last.stem() : last).stem().string();
}

void describe(Bone& bone, const ImportOptions& options, const ImportSummary& found) {
    add_provenance(bone, options, found, hash_of_source(options.input));
    bone.name = bone_name(options.input);
    bone.provenance["component"] = options.component.empty() ? "largest" : options.component;
    bone.provenance["fill"] = options.fill ? "marrow" : "none";
    if (!options.crop.empty()) bone.provenance["crop"] = options.crop + " mm";
}

/// Options whose jobs check for cancellation.
ImportOptions may_stop(ImportOptions options) {
    options.run = stoppable(std::move(options.run));
    return options;
}

SparseImport import_scan(const ImportOptions& options, const ImportReport& report, ImportSummary& found) {
    SparseImport made = import_ct(options, report, found);
    report(0.86, "measuring");
    measure(made.bone, found, options.run);
    if (options.pointshell) {
        report(0.9, "points");
        made.about.distance = dense_distance_of(made.bone);
        add_points(made.about, options, found);
        made.about.distance = {};
    }
    describe(made.about, options, found);
    return made;
}

Bone import_surface(const ImportOptions& options, const ImportReport& report, ImportSummary& found) {
    Bone bone = import_mesh(options, report, found);
    report(0.9, "measuring");
    measure(bone, found);
    add_points(bone, options, found);
    describe(bone, options, found);
    return bone;
}

}  // namespace

Bone import_bone(const ImportOptions& given, const ImportProgress& progress, ImportSummary* summary) {
    check_options(given);
    const ImportOptions options = may_stop(given);
    const ImportReport report{progress};
    ImportSummary found;
    Bone bone;
    if (volume::is_volume_file(options.input)) {
        SparseImport made = import_scan(options, report, found);
        bone = dense_of(made.bone);
        bone.name = std::move(made.about.name);
        bone.provenance = std::move(made.about.provenance);
        bone.points = std::move(made.about.points);
    } else {
        bone = import_surface(options, report, found);
    }
    if (summary) *summary = found;
    report(1.0, "done");
    return bone;
}

Bone shape_of_mesh(const std::filesystem::path& path, const std::optional<std::string>& unit, const RunJobs& run) {
    ImportOptions given;
    given.input = path;
    given.unit = unit;
    given.run = run;
    check_options(given);
    const ImportOptions options = may_stop(given);
    ImportSummary found;
    const ImportProgress unseen;
    Bone bone = import_mesh_shape(options, ImportReport{unseen}, found);
    check_shape(bone, found);
    describe(bone, options, found);
    return bone;
}

ImportSummary import_bone_file(const ImportOptions& given, const std::filesystem::path& out,
                               const ImportProgress& progress) {
    check_options(given);
    const ImportOptions options = may_stop(given);
    check_output(options, out);
    const ImportReport report{progress};
    ImportSummary found;
    if (volume::is_volume_file(options.input)) {
        SparseImport made = import_scan(options, report, found);
        report(0.92, "writing");
        save_bone(std::move(made.bone), made.about, out);
    } else {
        const Bone bone = import_surface(options, report, found);
        report(0.92, "writing");
        save_bone(bone, out);
    }
    report(1.0, "done");
    return found;
}

}  // namespace tactus::bone
