// SPDX-License-Identifier: Apache-2.0
// tactus snap: fits two fragments and reports a verdict.
#include "assets/bone/bone.hpp"
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/snapping.hpp"
#include "tools/command/kerf_option.hpp"
#include "tools/command/old_words.hpp"
#include "tools/command/pose_text.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/bone/fit_result.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace tactus::command {

namespace {

using file::Json;

struct SnapChoice {
    analysis::SnapSettings settings;
    std::string paint = "auto", start, mode = "extended";
    std::optional<double> kerf;  ///< mm
    ResultChoice result;
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
    if (choice.kerf) settings.kerf = *choice.kerf * 1e-3;
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

int snap(const SnapChoice& choice) {
    const std::string& paint = choice.paint;
    const std::size_t comma = std::min(paint.find(','), paint.size());
    check_result_files(choice.result, {choice.settings.moving, choice.settings.fixed, paint.substr(0, comma),
                                       paint.substr(std::min(comma + 1, paint.size()))});
    if (bone::name_one_bone(choice.settings.moving, choice.settings.fixed))
        throw Error(fmt::format("{}: a fragment cannot be fitted to itself; name two fragments",
                                choice.settings.moving.string()));
    const analysis::Snapped found = analysis::snap_files(settings_of(choice));
    write_result(report::snap_fields().of({choice.settings.moving.string(), choice.settings.fixed.string(), &found}),
                 choice.result);
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
    add_kerf(verb, choice->kerf);
    add_result_options(verb, choice->result, ResultFigure::none);
    verb.old([](std::vector<std::string>& words) { rename_value(words, "--mode", "thesis", "baseline"); });
    return [choice] { return snap(*choice); };
}

}  // namespace

Verb snap_verb() {
    return {
        .name = "snap", .about = "fit a fragment to another one, with a verdict", .add = declare_snap, .schema = [] {
            return report::schema_of_output({report::snap_fields().schema()});
        }};
}

}  // namespace tactus::command
