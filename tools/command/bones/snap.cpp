// SPDX-License-Identifier: Apache-2.0
// One fit of two fragments, with its verdict.
#include "assets/file/whole_file.hpp"
#include "assets/fracture/paint_file.hpp"
#include "assets/fracture/propose_paint.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/error.hpp"
#include "dsp/planning/as_scanned.hpp"
#include "dsp/snap/fit.hpp"
#include "tools/study/bones/fragment_file.hpp"
#include "tools/study/planning/plan_case.hpp"
#include "tools/snap_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

struct Fragment {
    Bone bone;
    std::string paint;  ///< where it comes from
};

/// Paints what lies within the strokes' radius: {"moving": [[x, y, z], ...], "fixed": [...], "radius_mm": r}, in mm.
void brush(std::vector<SurfacePoint>& points, const Json& strokes, const char* side, const std::string& file) {
    if (!strokes.is_object() || !strokes.contains(side) || !strokes[side].is_array())
        throw Error(
            fmt::format("{}: expected {{\"moving\": [[x, y, z], ...], \"fixed\": [...], \"radius_mm\": r}}", file));
    const double radius = 1e-3 * strokes.value("radius_mm", 1.0);
    for (SurfacePoint& p : points) p.label = surface_label::none;
    for (const Json& at : strokes[side]) {
        if (!at.is_array() || at.size() != 3 || !std::ranges::all_of(at, [](const Json& x) { return x.is_number(); }))
            throw Error(fmt::format("{}: a stroke of '{}' is no list of three numbers", file, side));
        const Vec3 centre(1e-3 * at[0].get<double>(), 1e-3 * at[1].get<double>(), 1e-3 * at[2].get<double>());
        for (SurfacePoint& p : points)
            if (glm::length(p.position - centre) <= radius) p.label = surface_label::fracture;
    }
}

Fragment load_fragment(const std::filesystem::path& path, const SnapChoice& choice, const char* side) {
    Fragment fragment{bone_of_file(path), "file"};
    if (fragment.bone.points.empty()) fragment.bone.points = sample_surface(fragment.bone.distance, {});
    const auto is_painted = [](const SurfacePoint& p) { return p.label == surface_label::fracture; };
    if (const auto comma = choice.paint.find(','); comma != std::string::npos) {
        fragment.paint =
            std::string_view(side) == "moving" ? choice.paint.substr(0, comma) : choice.paint.substr(comma + 1);
        paint_from_file(fragment.bone.points, fragment.paint);
    } else if (choice.paint != "auto") {
        const Json strokes = Json::parse(read_whole_file(choice.paint), nullptr, false);
        brush(fragment.bone.points, strokes, side, choice.paint);
        fragment.paint = choice.paint;
    } else if (std::ranges::none_of(fragment.bone.points, is_painted)) {
        propose_fracture(fragment.bone.points);
        fragment.paint = "proposed";
    }
    return fragment;
}

std::vector<FitSurface> faces_of(const Fragment& fragment, const std::filesystem::path& path) {
    try {
        return make_fit_faces(fragment.bone.points, fragment.bone.distance);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", path.string(), error.message()));
    }
}

Json painted_mm2(const std::vector<FitSurface>& faces) {
    Json areas = Json::array();
    for (const FitSurface& face : faces) areas.push_back(face.area * 1e6);
    return areas;
}

Json json_of(const Fit& fit) {
    Json free = Json::array();
    for (const FreeDirection& f : fit.free)
        free.push_back({{"type", f.is_turn ? "rotation" : "translation"}, {"axis", {f.axis.x, f.axis.y, f.axis.z}}});
    return {{"pose", pose_json<Json>(fit.pose)},
            {"score", fit.quality.score},
            {"margin", fit.margin},
            {"overlap_mm2", fit.quality.overlap * 1e6},
            {"rms_mm", fit.quality.rms * 1e3},
            {"gap_mm", fit.quality.gap * 1e3},
            {"penetration_mm", fit.quality.penetration * 1e3},
            {"outline_step_mm", fit.quality.outline * 1e3},
            {"free_directions", free},
            {"verdict", name_of(fit.verdict)}};
}

}  // namespace

int snap_verb(const SnapChoice& choice) {
    const Pose start = choice.start.empty() ? Pose{} : pose_of_text(choice.start, "--start");
    const Fragment moving = load_fragment(choice.moving, choice, "moving");
    const Fragment fixed = load_fragment(choice.fixed, choice, "fixed");
    const std::vector<FitSurface> moving_faces = faces_of(moving, choice.moving);
    const std::vector<FitSurface> fixed_faces = faces_of(fixed, choice.fixed);
    const FitMode mode = choice.mode == "thesis"   ? FitMode::thesis
                         : choice.mode == "global" ? FitMode::global
                                                   : FitMode::extended;
    const auto begin = std::chrono::steady_clock::now();
    Fit fit = find_fit(moving_faces, fixed_faces, start, mode);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
    const bool as_scanned =
        fit.verdict == FitVerdict::fit && is_as_scanned(moving.bone.points, fit.pose, make_voxmap(fixed.bone.distance));
    if (as_scanned) fit.verdict = FitVerdict::ambiguous;
    Json json = json_of(fit);
    json["moved"] = motion_json<Json>(start, fit.pose, moving.bone.points);
    json["as_scanned"] = as_scanned;
    json["time_ms"] = time.count();
    json["iterations"] = fit.iterations;
    json["paint"] = {{"moving", moving.paint}, {"fixed", fixed.paint}};
    json["painted_mm2"] = {{"moving", painted_mm2(moving_faces)}, {"fixed", painted_mm2(fixed_faces)}};
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else {
        const Vec3 p = fit.pose.position * 1e3;
        const Quat q = fit.pose.orientation;
        fmt::print("{}: score {:.2f}, margin {:.2f}, {:.0f} mm² on each other, {:.3f} mm rms, {:.0f} ms\n",
                   name_of(fit.verdict), fit.quality.score, fit.margin, fit.quality.overlap * 1e6,
                   fit.quality.rms * 1e3, time.count());
        fmt::print("p_fixed = R p_moving + t: t = {:.3f} {:.3f} {:.3f} mm, q = {:.5f} {:.5f} {:.5f} {:.5f}\n", p.x, p.y,
                   p.z, q.w, q.x, q.y, q.z);
        for (const FreeDirection& f : fit.free)
            fmt::print("free to {} {:.2f} {:.2f} {:.2f}\n", f.is_turn ? "turn about" : "slide along", f.axis.x,
                       f.axis.y, f.axis.z);
        if (as_scanned) fmt::print("{}\n", as_scanned_note);
    }
    return fit.verdict == FitVerdict::fit ? done : answer_is_no;
}

}  // namespace tactus
