// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"
#include "assets/bone/import_steps.hpp"
#include "assets/file/json.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/saw_spacing.hpp"
#include "tools/analysis/workers.hpp"
#include "tools/command/bone/scan_options.hpp"
#include "tools/command/options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <string_view>
#include <utility>

namespace tactus::command {

namespace {

struct ImportChoice : bone::ImportOptions {
    std::filesystem::path out;
    std::string fills = "marrow";
    bool json = false;
};

file::Json threshold_json(const bone::ImportSummary& s) {
    if (!s.threshold.hu) return nullptr;
    file::Json json{{"hu", *s.threshold.hu},
                    {"from", s.threshold.from},
                    {"above_mm3", s.threshold.above_mm3},
                    {"kept_mm3", s.threshold.kept_mm3}};
    if (s.threshold.mask_mm3) json["mask_mm3"] = *s.threshold.mask_mm3;
    return json;
}

std::string threshold_text(const bone::ImportSummary& s, const std::string& component) {
    if (!s.threshold.hu) return "";
    std::string text = fmt::format(
        "  threshold {:g} HU ({}): voxels of {:.1f} cm³ reach it, {:.1f} cm³ were kept ({})\n", *s.threshold.hu,
        s.threshold.from, s.threshold.above_mm3 * 1e-3, s.threshold.kept_mm3 * 1e-3,
        component == "largest" || component == "all" ? "component " + component : component + " largest components");
    if (s.hollow_mm3 + s.marrow_mm3 > 0.0)
        text += fmt::format(
            "  filled, with the density of the scan: {:.2f} cm³ of closed hollows, {:.2f} cm³ of marrow behind a "
            "shell that leaks (--fill none leaves both out)\n",
            s.hollow_mm3 * 1e-3, s.marrow_mm3 * 1e-3);
    if (s.threshold.mask_mm3)
        text += fmt::format("  the mask of the scan holds {:.1f} cm³; a lower --threshold takes more of it\n",
                            *s.threshold.mask_mm3 * 1e-3);
    return text;
}

file::Json json_of(const bone::ImportSummary& s) {
    return {{"frame", s.frame},
            {"hu", s.hu},
            {"voxel_mm", s.voxel_mm},
            {"size", s.size},
            {"bone_volume_mm3", s.bone_volume_mm3},
            {"surface_area_mm2", s.surface_area_mm2},
            {"density", {{"min", s.density.min}, {"max", s.density.max}, {"mean", s.density.mean}}},
            {"metal_mm3", s.metal_mm3},
            {"components", s.components},
            {"components_kept", s.components_kept},
            {"hollow_mm3", s.hollow_mm3},
            {"marrow_mm3", s.marrow_mm3},
            {"threshold", threshold_json(s)},
            {"narrowest_kerf_mm", analysis::narrowest_kerf_mm(s.voxel_mm)},
            {"points", s.points},
            {"notes", s.notes}};
}

// What the densities rest on.
std::string_view density_source(const bone::ImportSummary& s, const std::optional<double>& given) {
    if (s.hu == "none") return given ? "given" : "assumed";
    return s.hu == "masked" ? "from HU of a masked scan, without a density phantom"
                            : "from calibrated HU, without a density phantom";
}

std::string text_of(const bone::ImportSummary& s, const bone::ImportOptions& options) {
    std::string text = fmt::format(
        "{} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm\n  {:.0f} mm³ of bone, {:.0f} mm² of surface, {} "
        "found\n{}  density {:.0f} … {:.0f}, mean {:.0f} kg/m³ ({})\n  {}\n{}",
        s.size[0], s.size[1], s.size[2], s.voxel_mm[0], s.voxel_mm[1], s.voxel_mm[2], s.bone_volume_mm3,
        s.surface_area_mm2, counted(s.components, "component"),
        threshold_text(s, options.component.empty() ? "largest" : options.component), s.density.min, s.density.max,
        s.density.mean, density_source(s, options.mesh_density), analysis::saw_line(s.voxel_mm),
        s.points ? fmt::format("  {} on the surface\n", counted(s.points, "point")) : "");
    for (const std::string& note : s.notes) text += fmt::format("  {}\n", note);
    return text;
}

int import_label_map(const ImportChoice& choice, const bone::ImportOptions& options,
                     const bone::ImportProgress& progress, LiveLine& line) {
    bone::check_output(options, choice.out);
    std::vector<bone::ImportedBone> made = bone::import_labels(options, progress);
    line.clear();
    std::vector<bone::Bone> bones;
    for (bone::ImportedBone& each : made) bones.push_back(std::move(each.bone));
    bone::save_bones(bones, choice.out);
    file::Json list = file::Json::array();
    std::string text = choice.out.string() + "\n";
    for (std::size_t n = 0; n < bones.size(); ++n) {
        file::Json one{{"name", bones[n].name}, {"label", std::stoi(bones[n].provenance.at("label"))}};
        one.update(json_of(made[n].summary));
        list.push_back(std::move(one));
        text += fmt::format("{}: {}  surface: {}\n", bones[n].name, text_of(made[n].summary, choice),
                            bones[n].provenance.at("surface"));
    }
    if (choice.json) fmt::print("{}\n", file::Json{{"bones", list}, {"file", choice.out.string()}}.dump(2));
    else fmt::print("{}", text);
    return done;
}

int import_bone(const ImportChoice& choice) {
    LiveLine line;
    const bone::ImportProgress progress = [&line](double part, std::string_view doing) {
        line.show(fmt::format("{:3.0f} %  {}", 100.0 * part, doing));
    };
    bone::ImportOptions options = choice;
    options.run = analysis::on_threads();
    options.fill = choice.fills == "marrow";
    if (!choice.label.empty()) return import_label_map(choice, options, progress, line);
    if (!choice.ct.empty()) throw Error("--ct is for label maps: choose a label with --label N or --label all");
    const bone::ImportSummary summary = bone::import_bone_file(options, choice.out, progress);
    line.clear();
    file::Json json = json_of(summary);
    json["file"] = choice.out.string();
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else fmt::print("{}: {}", choice.out.string(), text_of(summary, choice));
    return done;
}

Action declare_import(VerbOptions& verb) {
    const auto choice = std::make_shared<ImportChoice>();
    verb.add("input", choice->input, "the file").required();
    verb.add("-o,--out", choice->out, "OpenVDB file for the bone").required();
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
    return [choice] { return import_bone(*choice); };
}

}  // namespace

Verb import_verb() {
    return {"import",
            "make a bone from a CT (DICOM folder or zip, NRRD, NIfTI, InVesalius) or a closed mesh (STL, PLY, OBJ)",
            declare_import};
}

}  // namespace tactus::command
