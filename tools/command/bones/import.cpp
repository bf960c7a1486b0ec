// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"
#include "assets/bone/import_steps.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/terminal.hpp"
#include "tools/verbs.hpp"
#include "tools/study/workers.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tactus {

namespace {

nlohmann::ordered_json json_of(const ImportSummary& s) {
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

std::string text_of(const ImportSummary& s) {
    std::string text = fmt::format(
        "{} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm\n  {:.0f} mm³ of bone, {:.0f} mm² of surface, {} "
        "component{} "
        "found\n  density {:.0f} … {:.0f}, mean {:.0f} kg/m³ ({})\n{}",
        s.size[0], s.size[1], s.size[2], s.voxel_mm[0], s.voxel_mm[1], s.voxel_mm[2], s.bone_volume_mm3,
        s.surface_area_mm2, s.components, s.components == 1 ? "" : "s", s.density.min, s.density.max, s.density.mean,
        s.hu, s.points ? fmt::format("  {} points on the surface\n", s.points) : "");
    for (const std::string& note : s.notes) text += fmt::format("  {}\n", note);
    return text;
}

int import_label_map(const ImportChoice& choice, const ImportOptions& options, const ImportProgress& progress,
                     LiveLine& line) {
    check_output(options, choice.out);
    std::vector<ImportedBone> made = import_labels(options, progress);
    line.clear();
    std::vector<Bone> bones;
    for (ImportedBone& each : made) bones.push_back(std::move(each.bone));
    save_bones(bones, choice.out);
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

}  // namespace

int import_verb(const ImportChoice& choice) {
    LiveLine line;
    const ImportProgress progress = [&line](double part, std::string_view doing) {
        line.show(fmt::format("{:3.0f} %  {}", 100.0 * part, doing));
    };
    ImportOptions options = choice;
    options.run = on_threads();
    if (!choice.label.empty()) return import_label_map(choice, options, progress, line);
    if (!choice.ct.empty()) throw Error("--ct goes with a label map: say which label with --label N or --label all");
    const ImportSummary summary = import_bone_file(options, choice.out, progress);
    line.clear();
    nlohmann::ordered_json json = json_of(summary);
    json["file"] = choice.out.string();
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else fmt::print("{}: {}", choice.out.string(), text_of(summary));
    return done;
}

}  // namespace tactus
