// SPDX-License-Identifier: Apache-2.0
// Proposes where a fragment is broken, and takes corrections by hand.
#include "assets/fracture/propose_paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "tools/fragment_file.hpp"
#include "assets/fracture/paint_file.hpp"
#include "tools/snap_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tactus {

int fracture_surface_verb(const FractureSurfaceChoice& choice) {
    const auto extension = choice.out.extension();
    if (extension != ".json" && extension != ".vdb")
        throw Error(fmt::format("{}: paint goes to a .json file of strokes or a .vdb bone file", choice.out.string()));
    Bone bone = bone_of_file(choice.bone);
    if (bone.points.empty()) bone.points = sample_surface(bone.distance, {});
    const bool has_paint =
        std::ranges::any_of(bone.points, [](const SurfacePoint& p) { return p.label == surface_label::fracture; });
    if (!choice.facing.empty()) {
        Bone other = bone_of_file(choice.facing);
        if (other.points.empty()) other.points = sample_surface(other.distance, {});
        propose_facing(bone.points, other.points,
                       {.reach = choice.reach * 1e-3, .least_area = choice.least_area * 1e-6});
    } else if (!choice.keep || !has_paint) {
        ProposalOptions options;
        options.roughness = choice.roughness;
        options.least_area = choice.least_area * 1e-6;
        propose_fracture(bone.points, options);
    }
    if (!choice.paint.empty()) paint_from_file(bone.points, choice.paint, choice.correct);
    std::vector<PaintedFace> faces;
    if (extension == ".json") faces = write_paint_file(bone.points, choice.bone.string(), choice.out);
    else {
        faces = painted_faces(bone.points);
        save_bone(bone, choice.out);
    }
    nlohmann::ordered_json json{{"file", choice.out.string()}, {"faces", nlohmann::ordered_json::array()}};
    for (const PaintedFace& f : faces) {
        const Vec3 p = f.middle * 1e3;
        json["faces"].push_back({{"area_mm2", f.area * 1e6},
                                 {"points", f.points},
                                 {"middle_mm", {p.x, p.y, p.z}},
                                 {"normal", {f.normal.x, f.normal.y, f.normal.z}}});
        if (!choice.json)
            fmt::print("{:.0f} mm² about {:.1f} {:.1f} {:.1f} mm, looking along {:.2f} {:.2f} {:.2f}\n", f.area * 1e6,
                       p.x, p.y, p.z, f.normal.x, f.normal.y, f.normal.z);
    }
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else if (faces.empty()) fmt::print("nothing looks broken; paint it by hand, or lower --roughness\n");
    return faces.empty() ? answer_is_no : done;
}

}  // namespace tactus
