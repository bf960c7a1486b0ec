// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"
#include "assets/bone/import_steps.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/workers.hpp"
#include "tools/command/bone/scan_options.hpp"
#include "tools/command/options.hpp"
#include "tools/command/progress.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/bone/scan_result.hpp"
#include "tools/report/result/printers.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <memory>
#include <string_view>
#include <utility>

namespace tactus::command {

namespace {

struct ImportChoice : bone::ImportOptions {
    std::filesystem::path out;
    std::string fills = "marrow";
    bool json = false, quiet = false;
};

std::string component_of(const ImportChoice& choice) { return choice.component.empty() ? "largest" : choice.component; }

void print_result(const report::Result& result, const ImportChoice& choice) {
    if (!choice.quiet) say(stdout, choice.json ? report::output_json(result).dump(2) + "\n" : report::text_of(result));
}

int import_label_map(const ImportChoice& choice, const bone::ImportOptions& options,
                     const bone::ImportProgress& progress, Progress& shown) {
    bone::check_output(options, choice.out);
    std::vector<bone::ImportedBone> made = bone::import_labels(options, progress);
    shown.clear();
    std::vector<bone::Bone> bones;
    for (bone::ImportedBone& each : made) bones.push_back(std::move(each.bone));
    bone::save_bones(bones, choice.out);
    report::ImportedBones result{choice.out.string(), {}};
    for (std::size_t n = 0; n < bones.size(); ++n)
        result.bones.push_back({&made[n].summary, component_of(choice), choice.mesh_density.has_value(), bones[n].name,
                                bones[n].provenance.at("surface"), std::stoi(bones[n].provenance.at("label"))});
    print_result(report::imported_labels_fields().of(result), choice);
    return done;
}

int import_bone(const ImportChoice& choice) {
    Progress shown(choice.quiet);
    const bone::ImportProgress progress = [&shown](double part, std::string_view doing) { shown.show(part, doing); };
    bone::ImportOptions options = choice;
    options.run = analysis::on_threads();
    options.fill = choice.fills == "marrow";
    if (!choice.label.empty()) return import_label_map(choice, options, progress, shown);
    if (!choice.ct.empty()) throw Error("--ct is for label maps: choose a label with --label N or --label all");
    const bone::ImportSummary summary = bone::import_bone_file(options, choice.out, progress);
    shown.clear();
    print_result(report::imported_bone_fields().of(
                     {choice.out.string(), {{&summary, component_of(choice), choice.mesh_density.has_value()}}}),
                 choice);
    return done;
}

Action declare_import(VerbOptions& verb) {
    const auto choice = std::make_shared<ImportChoice>();
    verb.add("input", choice->input, "the file").required();
    verb.output("-o,--out", choice->out, {{".vdb"}}, "OpenVDB file for the bone").required();
    verb.add("--threshold", choice->threshold,
             "CT number at and above which a voxel is bone, HU (default: the one that info suggests)")
        .unit("HU");
    verb.add("--crop", choice->crop, "x0:x1,y0:y1,z0:z1 in mm, LPS");
    verb.add("--component", choice->component,
             "parts to keep: largest, all, or a number, largest first (default: of a label all, else the largest)");
    verb.add("--fill", choice->fills,
             "of a CT, below the threshold inside of bone: marrow (closed hollows too, with their own density) or none")
        .shows_default()
        .one_of({"marrow", "none"});
    add_unit(verb, choice->unit);
    verb.add("--density", choice->mesh_density,
             "of a mesh, throughout, kg/m^3 (default: a cortex of 1800 to 2 mm depth around a core of 400)")
        .unit("kg/m^3");
    verb.call<double>(
            "--spacing,--isotropic", [choice](const double& mm) { choice->spacing = mm * 1e-3; },
            "resample to this grid spacing, mm")
        .unit("mm");
    verb.add("--series", choice->series,
             "DICOM: the series to take, by its UID or the end of it; several between commas are joined");
    verb.flag("--fill-gaps", choice->fill_gaps, "DICOM: interpolate where slices are missing (default: refuse)");
    add_rescale(verb, [choice](const Rescale& rescale) { choice->rescale = rescale; });
    verb.call<double>(
            "--pointshell", [choice](const double& mm) { choice->pointshell = mm * 1e-3; },
            "also sample contact points on the surface with this spacing, mm")
        .unit("mm");
    verb.flag("--by-curvature", choice->pointshell_by_curvature, "closer points where curvature is high");
    verb.add("--label", choice->label, "for a label map: number or name of a label, or all for one bone per label");
    verb.add("--ct", choice->ct, "the CT of a label map: grey values for surface and density");
    verb.flag("--json", choice->json, "print a summary as JSON");
    verb.flag("--quiet", choice->quiet, "print no summary, only errors");
    return [choice] { return import_bone(*choice); };
}

}  // namespace

Verb import_verb() {
    return {.name = "import",
            .about =
                "make a bone from a CT (DICOM folder or zip, NRRD, NIfTI, InVesalius) or a closed mesh (STL, PLY, OBJ)",
            .add = declare_import,
            .schema = [] {
                return report::schema_of_output(
                    {report::imported_bone_fields().schema(), report::imported_labels_fields().schema()});
            }};
}

}  // namespace tactus::command
