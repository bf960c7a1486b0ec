// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"
#include "assets/bone/import_steps.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/study/workers.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>
#include <utility>

namespace tactus::command {

namespace {

struct ImportChoice : bone::ImportOptions {
    std::filesystem::path out;
    bool json = false;
};

nlohmann::ordered_json json_of(const bone::ImportSummary& s) {
    return {{"frame", s.frame},
            {"hu", s.hu},
            {"voxel_mm", s.voxel_mm},
            {"size", s.size},
            {"bone_volume_mm3", s.bone_volume_mm3},
            {"surface_area_mm2", s.surface_area_mm2},
            {"density", {{"min", s.density.min}, {"max", s.density.max}, {"mean", s.density.mean}}},
            {"components", s.components},
            {"points", s.points},
            {"notes", s.notes}};
}

std::string text_of(const bone::ImportSummary& s) {
    std::string text = fmt::format(
        "{} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm\n  {:.0f} mm³ of bone, {:.0f} mm² of surface, {} "
        "found\n  density {:.0f} … {:.0f}, mean {:.0f} kg/m³ ({})\n{}",
        s.size[0], s.size[1], s.size[2], s.voxel_mm[0], s.voxel_mm[1], s.voxel_mm[2], s.bone_volume_mm3,
        s.surface_area_mm2, counted(s.components, "component"), s.density.min, s.density.max, s.density.mean, s.hu,
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
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    std::string text = choice.out.string() + "\n";
    for (std::size_t n = 0; n < bones.size(); ++n) {
        nlohmann::ordered_json one{{"name", bones[n].name}, {"label", std::stoi(bones[n].provenance.at("label"))}};
        one.update(json_of(made[n].summary));
        list.push_back(std::move(one));
        text += fmt::format("{}: {}  surface: {}\n", bones[n].name, text_of(made[n].summary),
                            bones[n].provenance.at("surface"));
    }
    if (choice.json) fmt::print("{}\n", nlohmann::ordered_json{{"bones", list}, {"file", choice.out.string()}}.dump(2));
    else fmt::print("{}", text);
    return done;
}

int import_bone(const ImportChoice& choice) {
    LiveLine line;
    const bone::ImportProgress progress = [&line](double part, std::string_view doing) {
        line.show(fmt::format("{:3.0f} %  {}", 100.0 * part, doing));
    };
    bone::ImportOptions options = choice;
    options.run = study::on_threads();
    if (!choice.label.empty()) return import_label_map(choice, options, progress, line);
    if (!choice.ct.empty()) throw Error("--ct is for label maps: choose a label with --label N or --label all");
    const bone::ImportSummary summary = bone::import_bone_file(options, choice.out, progress);
    line.clear();
    nlohmann::ordered_json json = json_of(summary);
    json["file"] = choice.out.string();
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else fmt::print("{}: {}", choice.out.string(), text_of(summary));
    return done;
}

std::pair<double, double> rescale_by_points(const std::string& text) {
    double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
    if (std::sscanf(text.c_str(), "%lf:%lf,%lf:%lf", &a, &b, &c, &d) != 4 || a == c || b == d)
        throw Error("--hu-calibration takes two points VALUE:HU, as in --hu-calibration 60:-1000,1084:0");
    const double slope = (d - b) / (c - a);
    return {slope, b - slope * a};
}

std::pair<double, double> rescale_of(const std::string& text) {
    double slope = 0.0, intercept = 0.0;
    if (std::sscanf(text.c_str(), "%lf,%lf", &slope, &intercept) != 2)
        throw Error("--rescale takes SLOPE,INTERCEPT, as in --rescale 1,-1024");
    return {slope, intercept};
}

Action add(VerbOptions& verb) {
    const auto choice = std::make_shared<ImportChoice>();
    verb.add("input", choice->input, "the file").required();
    verb.add("-o,--out", choice->out, "OpenVDB file for the bone").required();
    verb.add("--threshold", choice->threshold, "CT number at and above which a voxel is bone, HU")
        .unit("HU")
        .shows_default();
    verb.add("--crop", choice->crop, "x0:x1,y0:y1,z0:z1 in mm, LPS");
    verb.add("--component", choice->component, "parts to keep: largest, all, or a number, largest first")
        .shows_default();
    verb.add("--unit", choice->unit, "unit of a mesh: mm, cm or m").one_of({"mm", "cm", "m"});
    verb.call<double>(
            "--spacing,--isotropic", [choice](const double& mm) { choice->spacing = mm * 1e-3; },
            "resample to this grid spacing, mm")
        .unit("mm");
    verb.add("--series", choice->series, "DICOM: the series to take, by its UID or the end of it");
    verb.call<std::string>(
        "--hu-calibration",
        [choice](const std::string& text) {
            const auto [slope, intercept] = rescale_by_points(text);
            choice->rescale = {slope, intercept};
        },
        "scanner numbers to HU by two points: VALUE:HU,VALUE:HU");
    verb.call<std::string>(
        "--rescale",
        [choice](const std::string& text) {
            const auto [slope, intercept] = rescale_of(text);
            choice->rescale = {slope, intercept};
        },
        "scanner numbers to HU: SLOPE,INTERCEPT");
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
    return {"import", "make a bone from a CT (DICOM, NRRD, NIfTI, InVesalius) or a closed mesh (STL, PLY, OBJ)", add};
}

}  // namespace tactus::command
