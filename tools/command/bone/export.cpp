// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/export.hpp"
#include "assets/file/json.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/crop_bone.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

struct ExportChoice {
    std::filesystem::path input, out;
    std::string bone;             // empty: all bones of the file
    std::string quantity = "hu";  // of a volume: "hu", "density" or "distance"
    std::string crop;             // x0:x1,y0:y1,z0:z1, mm; empty: everything
    std::filesystem::path cut_of;  // the bone before the cut: only the part around the cut; may be empty
    bool json = false;
};

std::vector<bone::Bone> chosen_bones(const ExportChoice& choice) {
    if (choice.bone.empty() && bone::file_of_bone(choice.input) == choice.input) return bone::load_bones(choice.input);
    std::vector<bone::Bone> one;
    const std::string path = choice.input.string();
    one.push_back(bone::load_bone(choice.bone.empty() ? path : path + "#" + choice.bone));
    return one;
}

// Leaves the part in the box, or around the cut, of each bone.
void crop(std::vector<bone::Bone>& bones, const ExportChoice& choice, bool closed) {
    if (choice.crop.empty() && choice.cut_of.empty()) return;
    if (!choice.crop.empty() && !choice.cut_of.empty()) throw Error("--crop and --cut-of exclude each other");
    if (!choice.cut_of.empty() && bones.size() != 1) throw Error("--cut-of needs one bone; choose it with --bone");
    for (bone::Bone& bone : bones)
        bone = analysis::part_of_bone(bone,
                                      choice.crop.empty() ? analysis::box_of_cut(bone, bone::load_bone(choice.cut_of))
                                                          : analysis::parse_box(choice.crop),
                                      closed);
}

bone::BoneQuantity quantity_of(const std::string& text) {
    return text == "density"    ? bone::BoneQuantity::density
           : text == "distance" ? bone::BoneQuantity::distance
                                : bone::BoneQuantity::hu;
}

file::Json export_mesh(const std::vector<bone::Bone>& bones, const std::filesystem::path& out) {
    std::vector<mesh::ColouredSurface> surfaces;
    double volume = 0.0;
    std::size_t triangles = 0;
    for (const bone::Bone& bone : bones) {
        surfaces.push_back({mesh::export_surface(bone.distance), bone.colour});
        volume += mesh::volume_of(surfaces.back().surface);
        triangles += surfaces.back().surface.triangles.size();
    }
    mesh::write_mesh(surfaces, out);
    return {{"triangles", triangles}, {"volume_mm3", volume * 1e9}};
}

file::Json export_volume(const std::vector<bone::Bone>& bones, const ExportChoice& choice) {
    const bone::BoneQuantity quantity = quantity_of(choice.quantity);
    const volume::Grid volume = bone::volume_of_bones(bones, quantity);
    if (quantity == bone::BoneQuantity::hu)
        volume::write_volume(volume, volume::WrittenType::int16, choice.out, bone::surface_hu(bones));
    else volume::write_volume(volume, volume::WrittenType::float32, choice.out);
    const Vec3 h = volume.spacing * 1e3;
    return {{"quantity", choice.quantity}, {"size", volume.size}, {"spacing_mm", {h.x, h.y, h.z}}};
}

int export_bone(const ExportChoice& choice) {
    const std::string kind = choice.out.extension().string();
    const bool is_mesh = kind == ".stl" || kind == ".ply";
    std::vector<bone::Bone> bones = chosen_bones(choice);
    crop(bones, choice, is_mesh);
    file::Json json = is_mesh ? export_mesh(bones, choice.out) : export_volume(bones, choice);
    std::vector<std::string> names;
    for (const bone::Bone& bone : bones) names.push_back(bone.name);
    json["bones"] = names;
    json["file"] = choice.out.string();
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else if (is_mesh)
        fmt::print("{}: {} triangles around {:.0f} mm³, LPS, mm\n", choice.out.string(),
                   json["triangles"].get<std::size_t>(), json["volume_mm3"].get<double>());
    else
        fmt::print("{}: {} on {} x {} x {} samples\n", choice.out.string(), choice.quantity, json["size"][0].get<int>(),
                   json["size"][1].get<int>(), json["size"][2].get<int>());
    return done;
}

Action declare_export(VerbOptions& verb) {
    const auto choice = std::make_shared<ExportChoice>();
    verb.add("bone", choice->input, "bone file; FILE.vdb#NAME for one of several").required();
    verb.output("-o,--out", choice->out, {{".stl", ".ply", ".nrrd", ".nii", ".nii.gz"}},
                ".stl or .ply: the surface; .nrrd, .nii or .nii.gz: a volume")
        .required();
    verb.add("--bone", choice->bone, "one of several bones (default: all)");
    verb.add("--crop", choice->crop, "only this box: x0:x1,y0:y1,z0:z1 in mm, LPS");
    verb.add("--cut-of", choice->cut_of, "the bone before it was cut: only 5 mm around what the cut removed");
    verb.add("--quantity", choice->quantity, "quantity of a volume")
        .one_of({"hu", "density", "distance"})
        .shows_default();
    verb.flag("--json", choice->json, "print a summary as JSON");
    return [choice] { return export_bone(*choice); };
}

}  // namespace

Verb export_verb() { return {"export", "write a bone, cut or not, as a mesh or a volume", declare_export}; }

}  // namespace tactus::command
