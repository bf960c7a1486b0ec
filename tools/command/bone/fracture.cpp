// SPDX-License-Identifier: Apache-2.0
// tactus fracture: simulated, displaced fragments of a bone, with ground truth.
#include "tools/analysis/bone/fracture.hpp"
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/command/pose_text.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>
#include <vector>

namespace tactus::command {

namespace {

using file::Json;

struct FractureChoice {
    std::filesystem::path bone, out;
    analysis::FractureSettings settings;
    double chips = 0.0;                  // % of the area
    double kerf = 0.0, roughness = 0.8;  // mm
    double voxel = 0.35, blur = 0.25;    // mm
    double noise = 3.0;                  // % of the contrast
    double spread = 10.0, turn = 20.0;   // mm, degrees
    double spacing = 0.42;               // mm
    bool overwrite = false, json = false;
};

analysis::FractureSettings settings_of(const FractureChoice& choice) {
    analysis::FractureSettings settings = choice.settings;
    settings.chips = choice.chips * 1e-2;
    settings.kerf = choice.kerf * 1e-3;
    settings.roughness = choice.roughness * 1e-3;
    settings.voxel = choice.voxel * 1e-3;
    settings.blur = choice.blur * 1e-3;
    settings.noise = choice.noise * 1e-2;
    settings.spread = 1e-3 * choice.spread;
    settings.turn = choice.turn * std::numbers::pi / 180.0;
    settings.spacing = choice.spacing * 1e-3;
    return settings;
}

/// The files of an earlier call in the folder. Throws Error if they may not be replaced.
std::vector<std::filesystem::path> replaced_files(const FractureChoice& choice) {
    std::error_code failed;
    std::vector<std::filesystem::path> old;
    for (const auto& entry : std::filesystem::directory_iterator(choice.out, failed))
        if (const std::string name = entry.path().filename().string();
            name == "truth.json" ||
            (name.starts_with("fragment_") && (name.ends_with(".vdb") || name.ends_with(".stl"))))
            old.push_back(entry.path());
    if (!old.empty() && !choice.overwrite)
        throw Error(fmt::format(
            "{}: the folder already has results ({}); choose another one, or use --overwrite to replace them",
            choice.out.string(), std::ranges::min(old).filename().string()));
    return old;
}

int fracture(const FractureChoice& choice) {
    const std::vector<std::filesystem::path> old = replaced_files(choice);
    const analysis::FractureSettings settings = settings_of(choice);
    if (settings.missing > settings.pieces - 2) throw Error("at least two pieces must be left; lower --missing");
    const bone::Bone bone = analysis::bone_of_file(choice.bone);
    Json truth{{"bone", bone.name},
               {"seed", settings.seed},
               {"unit", "mm"},
               {"frame", "LPS"},
               {"chips_percent", choice.chips},
               {"kerf_mm", choice.kerf},
               {"pose", "p_bone = R p_fragment + t"},
               {"fragments", Json::array()},
               {"missing", settings.missing}};
    analysis::break_and_scan(bone, settings, [&](analysis::ScannedFragment fragment) {
        const std::size_t number = truth["fragments"].size() + 1;
        // The folder is made after the bone is broken, so that a failure leaves no folder.
        if (number == 1) {
            run::make_output_folder(choice.out);
            // Fewer new pieces would leave old ones among them.
            for (const std::filesystem::path& file : old) std::filesystem::remove(file);
        }
        const std::string name = fmt::format("fragment_{:02}", number);
        fragment.bone.name = name;
        bone::save_bone(fragment.bone, choice.out / (name + ".vdb"));
        const mesh::ColouredSurface surface{mesh::export_surface(fragment.bone.distance), fragment.bone.colour};
        mesh::write_mesh({&surface, 1}, choice.out / (name + ".stl"));
        truth["fragments"].push_back({{"fragment", name},
                                      {"pose", pose_json<Json>(fragment.place)},
                                      {"volume_mm3", fragment.volume * 1e9},
                                      {"files", {name + ".vdb", name + ".stl"}}});
        if (!choice.json) fmt::print("{}: {:.0f} mm³\n", name, fragment.volume * 1e9);
    });
    file::write_whole_file(choice.out / "truth.json", truth.dump(2) + "\n");
    if (choice.json) fmt::print("{}\n", truth.dump(2));
    return done;
}

Action declare_fracture(VerbOptions& verb) {
    const auto choice = std::make_shared<FractureChoice>();
    verb.add("bone", choice->bone, "bone file, or anything that import reads").required();
    verb.output("-o,--out", choice->out, OutputFormat::folder(), "folder for the fragments and truth.json").required();
    verb.add("--pieces", choice->settings.pieces, "number of pieces").shows_default().range(2, 200);
    verb.add("--seed", choice->settings.seed, "seed of the random fracture").shows_default();
    verb.add("--chips", choice->chips, "share of each fracture that is chipped off one side, %").range(0.0, 90.0);
    verb.add("--kerf", choice->kerf, "bone lost all along the fractures, mm").unit("mm").range(0.0, 5.0);
    verb.add("--missing", choice->settings.missing, "number of the smallest pieces that are lost").range(0, 198);
    verb.add("--roughness", choice->roughness, "root mean square relief, mm")
        .unit("mm")
        .shows_default()
        .range(0.0, 5.0);
    verb.add("--voxel", choice->voxel, "voxel size of the scan, mm").unit("mm").shows_default().range(0.1, 3.0);
    verb.add("--blur", choice->blur, "blur of the scan, standard deviation, mm")
        .unit("mm")
        .shows_default()
        .range(0.0, 3.0);
    verb.add("--noise", choice->noise, "noise of the scan, standard deviation, % of the contrast of bone")
        .shows_default()
        .range(0.0, 20.0);
    verb.add("--spread", choice->spread, "displacement of the fragments, mm")
        .unit("mm")
        .shows_default()
        .range(0.0, 1000.0);
    verb.add("--turn", choice->turn, "rotation of the fragments, degrees")
        .unit("deg")
        .shows_default()
        .range(0.0, 180.0);
    verb.add("--points", choice->spacing, "spacing of the surface points, mm")
        .unit("mm")
        .shows_default()
        .range(0.1, 5.0);
    verb.flag("--overwrite", choice->overwrite, "replace results that the folder already holds");
    verb.flag("--json", choice->json, "print truth.json as well");
    return [choice] { return fracture(*choice); };
}

}  // namespace

Verb fracture_verb() {
    return {"fracture", "break a bone into pieces and simulate scans of them, with ground truth", declare_fracture};
}

}  // namespace tactus::command
