// SPDX-License-Identifier: Apache-2.0
// Proposes where a fragment is broken, and takes corrections by hand.
#include "assets/fracture/paint_file.hpp"
#include "assets/fracture/propose_paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/bones/intact_side.hpp"
#include "tools/snap_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

std::vector<SurfacePoint> points_of_fragment(const std::filesystem::path& path) {
    const Bone bone = bone_of_file(path);
    return bone.points.empty() ? sample_surface(bone.distance, {}) : bone.points;
}

Json residual_json(const Registration& r) { return {{"median_mm", r.median * 1e3}, {"p90_mm", r.p90 * 1e3}}; }

/// What lies inside of the unbroken bone; returns how well that could be laid on the fragments.
Json propose_by_intact(std::vector<SurfacePoint>& points, const FractureSurfaceChoice& choice) {
    const std::vector<SurfacePoint> main = choice.main.empty() ? points : points_of_fragment(choice.main);
    const IntactSide intact = lay_intact_side(choice.intact, choice.mirror, main);
    const RegistrationTarget target(intact.points);
    Json json{{"file", choice.intact.string()}, {"on_main", residual_json(intact.registration)}};
    Pose place;
    if (!choice.main.empty()) {
        RegistrationSettings nearby;
        nearby.widest = 10e-3;
        const Registration own = register_surface(points, target, {}, nearby);
        place = own.pose;
        json["on_bone"] = residual_json(own);
    }
    IntactOptions options;
    if (choice.least_area) options.least_area = *choice.least_area * 1e-6;
    propose_inside(points, target, place, options);
    return json;
}

/// Labels what is proposed by the ways that are chosen; returns what is to be said about them.
Json propose(std::vector<SurfacePoint>& points, const FractureSurfaceChoice& choice) {
    if (!choice.intact.empty()) {
        Json json = propose_by_intact(points, choice);
        if (!choice.facing.empty()) keep_patches_near(points, points_of_fragment(choice.facing), choice.reach * 1e-3);
        return json;
    }
    if (!choice.facing.empty()) {
        FacingOptions options;
        options.reach = choice.reach * 1e-3;
        if (choice.least_area) options.least_area = *choice.least_area * 1e-6;
        propose_facing(points, points_of_fragment(choice.facing), options);
        return nullptr;
    }
    ProposalOptions options;
    options.roughness = choice.roughness;
    if (choice.least_area) options.least_area = *choice.least_area * 1e-6;
    propose_fracture(points, options);
    return nullptr;
}

}  // namespace

int fracture_surface_verb(const FractureSurfaceChoice& choice) {
    const auto extension = choice.out.extension();
    if (extension != ".json" && extension != ".vdb")
        throw Error(fmt::format("{}: paint goes to a .json file of strokes or a .vdb bone file", choice.out.string()));
    Bone bone = bone_of_file(choice.bone);
    if (bone.points.empty()) bone.points = sample_surface(bone.distance, {});
    const bool has_paint =
        std::ranges::any_of(bone.points, [](const SurfacePoint& p) { return p.label == surface_label::fracture; });
    if (choice.keep && has_paint && !(choice.facing.empty() && choice.intact.empty()))
        throw Error(
            fmt::format("{}: has paint already, which --keep starts from, so --facing and --intact would change "
                        "nothing; leave --keep out to propose anew",
                        choice.bone.string()));
    Json intact;
    if (!choice.keep || !has_paint) intact = propose(bone.points, choice);
    if (!choice.paint.empty()) paint_from_file(bone.points, choice.paint, choice.correct);
    std::vector<PaintedFace> faces;
    if (extension == ".json") faces = write_paint_file(bone.points, choice.bone.string(), choice.out);
    else {
        faces = painted_faces(bone.points);
        save_bone(bone, choice.out);
    }
    Json json{{"file", choice.out.string()}, {"faces", Json::array()}};
    if (!intact.is_null()) json["intact"] = intact;
    for (const char* side : {"on_main", "on_bone"})
        if (!choice.json && intact.contains(side))
            fmt::print("the unbroken bone lies {}: median {:.2f} mm, 90 % within {:.2f} mm\n",
                       side == std::string_view("on_main") ? "on the main fragment" : "on this one, by itself",
                       intact[side]["median_mm"].get<double>(), intact[side]["p90_mm"].get<double>());
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
