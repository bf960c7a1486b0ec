// SPDX-License-Identifier: Apache-2.0
#include "tools/bone_options.hpp"

#include "dsp/core/error.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace tactus {

namespace {

void add_import(CLI::App& app, ImportChoice& choice) {
    CLI::App* verb = app.add_subcommand(
        "import", "make a bone from a CT (DICOM, NRRD, NIfTI, InVesalius) or a closed mesh (STL, PLY, OBJ)");
    verb->add_option("input", choice.input, "the file")->required();
    verb->add_option("-o,--out", choice.out, "the bone, an OpenVDB file")->required();
    verb->add_option("--threshold", choice.threshold, "CT number from which on there is bone, HU")
        ->capture_default_str();
    verb->add_option("--crop", choice.crop, "x0:x1,y0:y1,z0:z1 in mm, LPS");
    verb->add_option("--component", choice.component, "largest, all, or how many of the largest")
        ->capture_default_str();
    verb->add_option("--unit", choice.unit, "unit of a mesh: mm, cm or m")->check(CLI::IsMember({"mm", "cm", "m"}));
    verb->add_option_function<double>(
        "--spacing,--isotropic", [&choice](const double& mm) { choice.spacing = mm * 1e-3; },
        "resample to this grid spacing, mm");
    verb->add_option("--series", choice.series, "DICOM: the series to take, by its UID or the end of it");
    verb->add_option_function<std::string>(
        "--hu-calibration",
        [&choice](const std::string& text) {
            double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
            if (std::sscanf(text.c_str(), "%lf:%lf,%lf:%lf", &a, &b, &c, &d) != 4 || a == c || b == d)
                throw Error("--hu-calibration takes two points VALUE:HU, as in --hu-calibration 60:-1000,1084:0");
            const double slope = (d - b) / (c - a);
            choice.rescale = {slope, b - slope * a};
        },
        "scanner numbers to HU by two points: VALUE:HU,VALUE:HU");
    verb->add_option_function<std::string>(
        "--rescale",
        [&choice](const std::string& text) {
            double slope = 0.0, intercept = 0.0;
            if (std::sscanf(text.c_str(), "%lf,%lf", &slope, &intercept) != 2)
                throw Error("--rescale takes SLOPE,INTERCEPT, as in --rescale 1,-1024");
            choice.rescale = {slope, intercept};
        },
        "scanner numbers to HU: SLOPE,INTERCEPT");
    verb->add_option_function<double>(
        "--pointshell", [&choice](const double& mm) { choice.pointshell = mm * 1e-3; },
        "also spread points over the surface for contact, this far apart, mm");
    verb->add_flag("--by-curvature", choice.pointshell_by_curvature, "points closer together where the surface turns");
    verb->add_option("--label", choice.label, "the file is a label map: a label's number or name, or all; a bone each");
    verb->add_option("--ct", choice.ct, "the CT a label map was drawn on: grey values for surface and density");
    verb->add_flag("--json", choice.json, "print a summary as JSON");
}

void add_info(CLI::App& app, InfoChoice& choice) {
    CLI::App* verb = app.add_subcommand("info", "what is in a CT, label map, mesh or bone file");
    verb->add_option("file", choice.input, "the file")->required();
    verb->add_option("--series", choice.series, "DICOM: the series to look at, by its UID or the end of it");
    verb->add_option("-o,--out", choice.out, "a PNG of three slices and the surface: a file, or a folder to put it in");
    verb->add_flag("--json", choice.json, "as JSON");
}

void add_export(CLI::App& app, ExportChoice& choice) {
    CLI::App* verb = app.add_subcommand("export", "write a bone, cut or not, as a mesh or a volume");
    verb->add_option("bone", choice.input, "bone file; FILE.vdb#NAME for one of several")->required();
    verb->add_option("-o,--out", choice.out, ".stl or .ply: the surface; .nrrd, .nii or .nii.gz: a volume")->required();
    verb->add_option("--bone", choice.bone, "one of several bones (default: all)");
    verb->add_option("--quantity", choice.quantity, "what a volume holds")
        ->check(CLI::IsMember({"hu", "density", "distance"}))
        ->capture_default_str();
    verb->add_flag("--json", choice.json, "print a summary as JSON");
}

}  // namespace

void add_bone_verbs(CLI::App& app, BoneChoices& choices) {
    add_import(app, choices.import);
    add_info(app, choices.info);
    add_export(app, choices.surface);
}

}  // namespace tactus
