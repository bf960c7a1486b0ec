// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/import.hpp"

#include "assets/bone/import_steps.hpp"

namespace tactus {

namespace {

// "jaw" of jaw.nii.gz and of the folder jaw/.
std::string bone_name(const std::filesystem::path& input) {
    const std::filesystem::path last = input.filename().empty() ? input.parent_path().filename() : input.filename();
    return (last.extension() == ".gz" ? last.stem() : last).stem().string();
}

}  // namespace

Bone import_bone(const ImportOptions& options, const ImportProgress& progress, ImportSummary* summary) {
    check_options(options);
    const ImportReport report{progress};
    ImportSummary found;
    Bone bone = is_volume_file(options.input) ? import_ct(options, report, found) : import_mesh(options, report, found);
    report(0.9, "measuring");
    measure(bone, found);
    add_points(bone, options, found);
    add_provenance(bone, options, found, hash_of_source(options.input));
    bone.name = bone_name(options.input);
    bone.provenance["component"] = options.component;
    bone.provenance["fill"] = options.fill ? "true" : "false";
    if (!options.crop.empty()) bone.provenance["crop"] = options.crop + " mm";
    if (summary) *summary = found;
    report(1.0, "done");
    return bone;
}

}  // namespace tactus
