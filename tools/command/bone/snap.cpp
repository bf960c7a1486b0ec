// SPDX-License-Identifier: Apache-2.0
// tactus snap: fits two fragments and reports a verdict.
#include "assets/bone/bone.hpp"
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/snapping.hpp"
#include "tools/command/old_words.hpp"
#include "tools/command/options.hpp"
#include "tools/command/pose_text.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <utility>

namespace tactus::command {

namespace {

using file::Json;

struct SnapChoice {
    analysis::SnapSettings settings;
    std::string paint = "auto", start, mode = "extended";
    bool json = false;
};

/// Of one side: {"moving": [[x, y, z], ...], "fixed": [...], "radius_mm": r}, in mm.
analysis::FragmentPaint strokes_of(const Json& strokes, const char* side, const std::string& file) {
    if (!strokes.is_object() || !strokes.contains(side) || !strokes[side].is_array())
        throw Error(
            fmt::format("{}: expected {{\"moving\": [[x, y, z], ...], \"fixed\": [...], \"radius_mm\": r}}", file));
    analysis::FragmentPaint paint{{}, {}, 1e-3 * strokes.value("radius_mm", 1.0), file};
    for (const Json& at : strokes[side]) {
        if (!at.is_array() || at.size() != 3 || !std::ranges::all_of(at, [](const Json& x) { return x.is_number(); }))
            throw Error(fmt::format("{}: a stroke of '{}' is not a list of three numbers", file, side));
        paint.strokes.emplace_back(1e-3 * at[0].get<double>(), 1e-3 * at[1].get<double>(), 1e-3 * at[2].get<double>());
    }
    return paint;
}

analysis::SnapSettings settings_of(const SnapChoice& choice) {
    analysis::SnapSettings settings = choice.settings;
    if (!choice.start.empty()) settings.start = pose_of_text(choice.start, "--start");
    settings.mode = choice.mode == "baseline" ? fit::FitMode::thesis
                    : choice.mode == "global" ? fit::FitMode::global
                                              : fit::FitMode::extended;
    if (const auto comma = choice.paint.find(','); comma != std::string::npos) {
        settings.moving_paint.file = choice.paint.substr(0, comma);
        settings.fixed_paint.file = choice.paint.substr(comma + 1);
    } else if (choice.paint != "auto") {
        const Json strokes = Json::parse_or_null(file::read_whole_file(choice.paint));
        settings.moving_paint = strokes_of(strokes, "moving", choice.paint);
        settings.fixed_paint = strokes_of(strokes, "fixed", choice.paint);
    }
    return settings;
}

Json painted_mm2(const analysis::SnappedSide& side) {
    Json areas = Json::array();
    for (const double area : side.areas) areas.push_back(area * 1e6);
    return areas;
}

Json json_of(const fit::Fit& fit) {
    Json free = Json::array();
    for (const fit::FreeDirection& f : fit.free)
        free.push_back(
            {{"type", f.is_rotation ? "rotation" : "translation"}, {"axis", {f.axis.x, f.axis.y, f.axis.z}}});
    return {{"pose", pose_json<Json>(fit.pose)},
            {"score", fit.quality.score},
            {"margin", fit.margin},
            {"held_at_far_end_mm", fit.precision.far * 1e3},
            {"held_deg", fit.precision.turn * 180.0 / std::numbers::pi},
            {"overlap_mm2", fit.quality.overlap * 1e6},
            {"rms_mm", fit.quality.rms * 1e3},
            {"gap_mm", fit.quality.gap * 1e3},
            {"penetration_mm", fit.quality.penetration * 1e3},
            {"outline_step_mm", fit.quality.outline * 1e3},
            {"free_directions", free},
            {"verdict", fit::name_of(fit.verdict)},
            {"answer", fit::answer_of(fit.verdict)},
            {"bound", bound_json<Json>(fit.bound)}};
}

Json json_of(const analysis::Snapped& found) {
    Json json = json_of(found.fit);
    json["moved"] = motion_json<Json>(found.moved);
    json["as_scanned"] = found.as_scanned;
    json["time_ms"] = 1e3 * found.seconds;
    json["iterations"] = found.fit.iterations;
    json["paint"] = {{"moving", found.moving.paint}, {"fixed", found.fixed.paint}};
    json["as_scanned_mm2"] = {{"moving", 1e6 * found.moving.as_scanned}, {"fixed", 1e6 * found.fixed.as_scanned}};
    json["painted_mm2"] = {{"moving", painted_mm2(found.moving)}, {"fixed", painted_mm2(found.fixed)}};
    return json;
}

void print(const SnapChoice& choice, const analysis::Snapped& found) {
    const fit::Fit& fit = found.fit;
    const Vec3 p = fit.pose.position * 1e3;
    const Quat q = fit.pose.orientation;
    fmt::print("{}: score {:.2f}, margin {:.2f}, {:.0f} mm² on each other, {:.3f} mm rms, {:.0f} ms\n",
               fit::name_of(fit.verdict), fit.quality.score, fit.margin, fit.quality.overlap * 1e6,
               fit.quality.rms * 1e3, 1e3 * found.seconds);
    fmt::print("p_fixed = R p_moving + t: t = {:.3f} {:.3f} {:.3f} mm, q = {:.5f} {:.5f} {:.5f} {:.5f}\n", p.x, p.y,
               p.z, q.w, q.x, q.y, q.z);
    if (has_bound(fit.verdict)) fmt::print("{}\n", bound_words(fit.verdict, fit.bound));
    for (const fit::FreeDirection& f : fit.free)
        fmt::print("free to {} {:.2f} {:.2f} {:.2f}\n", f.is_rotation ? "turn about" : "slide along", f.axis.x,
                   f.axis.y, f.axis.z);
    if (found.as_scanned) fmt::print("{}\n", as_scanned_note);
    const analysis::SnapSettings& files = choice.settings;
    for (const auto& [side, file] : {std::pair(&found.moving, &files.moving), {&found.fixed, &files.fixed}})
        if (side->as_scanned > 0.0) fmt::print("{}\n", left_out_words(file->string(), side->as_scanned));
}

int snap(const SnapChoice& choice) {
    if (bone::name_one_bone(choice.settings.moving, choice.settings.fixed))
        throw Error(fmt::format("{}: a fragment cannot be fitted to itself; name two fragments",
                                choice.settings.moving.string()));
    const analysis::Snapped found = analysis::snap_files(settings_of(choice));
    if (choice.json) fmt::print("{}\n", json_of(found).dump(2));
    else print(choice, found);
    return found.fit.verdict == fit::FitVerdict::fit ? done : answer_is_no;
}

Action declare_snap(VerbOptions& verb) {
    const auto choice = std::make_shared<SnapChoice>();
    verb.add("moving", choice->settings.moving, "the moving fragment: bone file or closed mesh").required();
    verb.add("fixed", choice->settings.fixed, "the fixed fragment").required();
    verb.add("--paint", choice->paint,
             "auto: the paint in the bone files, otherwise a proposal; or a JSON file of brush strokes, or two files "
             "of 'fracture-surface': MOVING.json,FIXED.json")
        .shows_default();
    verb.add("--start", choice->start,
             "X,Y,Z,QW,QX,QY,QZ in mm: start pose of the moving fragment (default: as in the file)");
    verb.add("--mode", choice->mode, "extended and baseline (Olsson 2015) start from there, global from anywhere")
        .one_of({"extended", "global", "baseline"})
        .shows_default();
    verb.flag("--json", choice->json, "as JSON");
    verb.old([](std::vector<std::string>& words) { rename_value(words, "--mode", "thesis", "baseline"); });
    return [choice] { return snap(*choice); };
}

}  // namespace

Verb snap_verb() { return {"snap", "fit a fragment to another one, with a verdict", declare_snap}; }

}  // namespace tactus::command
