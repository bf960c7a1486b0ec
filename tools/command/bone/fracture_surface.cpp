// SPDX-License-Identifier: Apache-2.0
// tactus fracture-surface: proposes the fracture surface of a fragment and applies manual corrections.
#include "tools/analysis/bone/fracture_surface.hpp"
#include "assets/file/json.hpp"
#include "assets/plan/paint_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/bone/pose_fields.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

using file::Json;

struct FractureSurfaceChoice {
    analysis::FractureSurfaceSettings settings;
    std::filesystem::path out;
    double reach = 10.0;               // mm
    std::optional<double> min_area;  // mm²
    bool json = false;
};

Json residual_json(const fit::Registration& r) { return {{"median_mm", r.median * 1e3}, {"p90_mm", r.p90 * 1e3}}; }

bool is_doubtful(const analysis::FractureSurface& found) {
    return found.intact && found.intact->on_main.median > analysis::max_intact_median;
}

std::string doubt_words(const FractureSurfaceChoice& choice) {
    return fmt::format(
        "the unbroken bone lies more than {:.0f} mm away from half of the {}fragment: what is proposed is not its "
        "fracture; {}check that it is the same bone{}",
        analysis::max_intact_median * 1e3, choice.settings.main.empty() ? "" : "main ",
        choice.settings.main.empty() ? "name the largest fragment of the same scan with --main, and " : "",
        choice.settings.mirror ? "" : ", and --mirror if it is from the other side of the body");
}

Json json_of(const FractureSurfaceChoice& choice, const analysis::FractureSurface& found,
             const std::vector<plan::PaintedFace>& faces) {
    Json json{{"file", choice.out.string()}, {"as_scanned_mm2", found.as_scanned * 1e6}, {"faces", Json::array()}};
    if (found.intact) {
        json["intact"] = {{"file", choice.settings.intact.string()}, {"on_main", residual_json(found.intact->on_main)}};
        if (found.intact->on_bone) json["intact"]["on_bone"] = residual_json(*found.intact->on_bone);
        json["intact"]["doubt"] = is_doubtful(found) ? Json(doubt_words(choice)) : Json(nullptr);
    }
    for (const plan::PaintedFace& f : faces) {
        const Vec3 p = f.middle * 1e3;
        json["faces"].push_back({{"area_mm2", f.area * 1e6},
                                 {"points", f.points},
                                 {"middle_mm", {p.x, p.y, p.z}},
                                 {"normal", {f.normal.x, f.normal.y, f.normal.z}}});
    }
    return json;
}

void print_laid(const char* where, const fit::Registration& r) {
    fmt::print("the unbroken bone lies {}: median {:.2f} mm, 90 % within {:.2f} mm\n", where, r.median * 1e3,
               r.p90 * 1e3);
}

void print(const FractureSurfaceChoice& choice, const analysis::FractureSurface& found,
           const std::vector<plan::PaintedFace>& faces) {
    if (found.intact) print_laid("on the main fragment", found.intact->on_main);
    if (found.intact && found.intact->on_bone) print_laid("on this one, by itself", *found.intact->on_bone);
    for (const plan::PaintedFace& f : faces) {
        const Vec3 p = f.middle * 1e3;
        fmt::print("{:.0f} mm² about {:.1f} {:.1f} {:.1f} mm, looking along {:.2f} {:.2f} {:.2f}\n", f.area * 1e6, p.x,
                   p.y, p.z, f.normal.x, f.normal.y, f.normal.z);
    }
    if (found.as_scanned > 0.0)
        fmt::print("{}\n", report::left_out_words(choice.settings.bone.string(), found.as_scanned));
    if (faces.empty()) fmt::print("no fracture surface found; paint it by hand, or lower --roughness\n");
}

int fracture_surface(const FractureSurfaceChoice& choice) {
    const auto extension = choice.out.extension();
    if (extension != ".json" && extension != ".vdb")
        throw Error(
            fmt::format("{}: paint can be written as .json (strokes) or .vdb (bone file)", choice.out.string()));
    for (const std::filesystem::path& other : choice.settings.facing)
        if (bone::name_one_bone(choice.settings.bone, other))
            throw Error(
                fmt::format("{}: a fragment cannot face itself; name another one with --facing", other.string()));
    analysis::FractureSurfaceSettings settings = choice.settings;
    settings.reach = choice.reach * 1e-3;
    if (choice.min_area) settings.min_area = *choice.min_area * 1e-6;
    settings.whole = extension == ".vdb";
    const analysis::FractureSurface found = analysis::propose_fracture_surface(settings);
    if (!found.note.empty()) fmt::print(stderr, "note: {}\n", found.note);
    std::vector<plan::PaintedFace> faces;
    if (extension == ".json") faces = plan::write_paint_file(found.bone.points, settings.bone.string(), choice.out);
    else {
        faces = plan::painted_faces(found.bone.points);
        bone::save_bone(found.bone, choice.out);
    }
    if (choice.json) fmt::print("{}\n", json_of(choice, found, faces).dump(2));
    else {
        print(choice, found, faces);
        if (is_doubtful(found)) fmt::print("! {}\n", doubt_words(choice));
    }
    return faces.empty() || is_doubtful(found) ? answer_is_no : done;
}

Action declare_fracture_surface(VerbOptions& verb) {
    const auto choice = std::make_shared<FractureSurfaceChoice>();
    analysis::FractureSurfaceSettings& settings = choice->settings;
    verb.add("bone", settings.bone, "bone file or closed mesh").required();
    verb.add("-o,--out", choice->out, ".json: brush strokes for correction by hand; .vdb: the bone with its paint")
        .required();
    verb.add("--paint", settings.paint, "use this file of strokes instead of the proposal");
    verb.flag("--correct", settings.correct, "apply the strokes of --paint on top of the proposal");
    verb.add("--facing", settings.facing,
             "another fragment of the same scan: propose the surface that faces it, also when it is smooth; once per "
             "neighbour")
        .one_each();
    const Option intact = verb.add(
        "--intact", settings.intact,
        "the unbroken bone, in any position: propose the surface inside of it; with --facing only near that fragment");
    verb.flag("--mirror", settings.mirror, "mirror the unbroken bone: it is from the other side of the body")
        .needs(intact);
    verb.add("--main", settings.main,
             "the fragment of the same scan to which the unbroken bone is registered first (default: this one)")
        .needs(intact);
    verb.add("--reach", choice->reach, "greatest distance to --facing or --intact, mm")
        .unit("mm")
        .shows_default()
        .range(0.1, 100.0);
    verb.flag("--keep", settings.keep,
              "keep the paint in the bone file; what --facing or --intact propose is added to it");
    verb.add("--roughness", settings.roughness,
             "roughness above which a point counts as broken: mean of 1 - cos of normals")
        .shows_default()
        .range(0.0, 1.0);
    verb.add("--least-area", choice->min_area, "smallest patch, mm² (default: 20, with --intact 50)")
        .unit("mm^2")
        .range(0.0, 1e5);
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return fracture_surface(*choice); };
}

}  // namespace

Verb fracture_surface_verb() {
    return {"fracture-surface",
            "propose the fracture surface of a fragment; 1: none found, or the unbroken bone does not lie on it",
            declare_fracture_surface};
}

}  // namespace tactus::command
