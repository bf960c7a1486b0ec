// SPDX-License-Identifier: Apache-2.0
// tactus plan mirror: registers the mirrored healthy side as a target.
#include "tools/analysis/plan/plan_mirror.hpp"
#include "assets/file/json.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/command/pose_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace tactus::command {

namespace {

using file::Json;

struct MirrorChoice : PlanChoice {
    std::filesystem::path healthy;
    bool settle = false, same_side = false;
    double max_residual = analysis::max_intact_median / mm;
};

Json faces_json(const analysis::FacesThere& faces) {
    return {{"contact_mm2", faces.contact * 1e6},
            {"gap_median_mm", faces.facing > 0.0 ? Json(faces.median * 1e3) : Json(nullptr)},
            {"deepest_mm", faces.deepest * 1e3},
            {"overlap_mm3", faces.overlap * 1e9}};
}

Json comparison_json(const std::string& fragment, const analysis::MirrorComparison& c) {
    return {{"fragment", fragment},
            {"away", motion_json<Json>(c.away)},
            {"median_before_mm", c.registration.before * 1e3},
            {"median_after_mm", c.registration.median * 1e3},
            {"faces", {{"before", faces_json(c.before)}, {"after", faces_json(c.after)}}},
            {"pose", pose_json<Json>(c.registration.pose)}};
}

void print_faces(const std::string& fragment, const char* when, const std::string& main,
                 const analysis::FacesThere& faces) {
    fmt::print("  {} {}: {:.0f} mm² touch {}, {:.0f} mm³ overlap, {:.2f} mm deep\n", fragment, when,
               faces.contact * 1e6, main, faces.overlap * 1e9, faces.deepest * 1e3);
}

void print_comparison(const std::string& fragment, const std::string& main, const analysis::MirrorComparison& c) {
    fmt::print(
        "{}: {:.2f} mm and {:.2f}° from its best pose on the target; median {:.2f} mm, there "
        "{:.2f} mm\n",
        fragment, 1e3 * c.away.distance, c.away.angle_deg, c.registration.before * 1e3, c.registration.median * 1e3);
    print_faces(fragment, "where it was", main, c.before);
    print_faces(fragment, "there", main, c.after);
}

/// A side that lies wrongly is no target: the plan does not use it, and nothing is compared with it.
bool is_doubtful(const MirrorChoice& choice, const fit::MirrorFit& fit) {
    return fit.registration.median > choice.max_residual * mm;
}

const char* target_words(const MirrorChoice& choice) { return choice.same_side ? "same side" : "mirrored side"; }

std::string doubt_words(const MirrorChoice& choice) {
    return fmt::format(
        "the {} lies more than {:.3g} mm away from half of '{}', so that it is no target: name the largest fragment "
        "first, and check that {} is the same bone of {} side, or raise --max-residual; the plan is "
        "unchanged",
        target_words(choice), choice.max_residual, choice.names[0], choice.healthy.string(),
        choice.same_side ? "the same" : "the other");
}

Json json_of(const MirrorChoice& choice, const fit::MirrorFit& fit, const Json& others) {
    return {{"on", choice.names[0]},
            {"mirrored", !choice.same_side},
            {"doubt", is_doubtful(choice, fit) ? Json(doubt_words(choice)) : Json(nullptr)},
            {"residual_mm", fit.registration.median * 1e3},
            {"residual_p90_mm", fit.registration.p90 * 1e3},
            {"plane_normal", {fit.plane.normal.x, fit.plane.normal.y, fit.plane.normal.z}},
            {"plane_offset_mm", fit.plane.offset * 1e3},
            {"asymmetry", {{"angle_deg", fit.rotation * 180.0 / std::numbers::pi}, {"distance_mm", fit.glide * 1e3}}},
            {"others", others}};
}

void add_target(plan::CasePlan& plan, const analysis::MirrorStudy& laid, const MirrorChoice& choice) {
    plan::PlanStep step;
    step.kind = plan::StepKind::mirror;
    step.by = "command";
    step.mirror = laid.target();
    analysis::do_step(plan, std::move(step), choice.plan);
}

/// Compares the other fragments with the mirrored side, and moves them there when that is asked.
Json compare_others(plan::CasePlan& plan, analysis::MirrorStudy& laid, const std::vector<int>& others,
                    const MirrorChoice& choice) {
    Json compared = Json::array();
    for (const int other : others) {
        const std::string& name = plan.fragments[static_cast<std::size_t>(other)].name;
        const analysis::MirrorComparison found = laid.compare(other, plan::state_of(plan).arrangement.pose(other));
        compared.push_back(comparison_json(name, found));
        if (!choice.json) print_comparison(name, choice.names[0], found);
        if (choice.settle)
            analysis::change_plan(plan, plan::PlaceFragment{other, found.registration.pose}, {.by = "mirror"},
                                  choice.plan);
    }
    return compared;
}

int mirror(const MirrorChoice& choice) {
    analysis::OpenPlan open(choice.plan);
    plan::CasePlan& plan = open.plan;
    const std::filesystem::path folder = choice.plan.parent_path();
    std::vector<int> numbers;
    for (const std::string& name : choice.names) {
        numbers.push_back(plan::find_fragment(plan, name));
        if (std::ranges::count(numbers, numbers.back()) > 1)
            throw Error(
                fmt::format("'{}' is named twice; the first is the main fragment, the others are brought to it", name));
    }
    analysis::MirrorStudy laid(plan, folder, numbers[0], choice.healthy, !choice.same_side);
    const bool is_refused = is_doubtful(choice, laid.fit());
    Json others = Json::array();
    if (!is_refused) {
        add_target(plan, laid, choice);
        numbers.erase(numbers.begin());
        others = compare_others(plan, laid, numbers, choice);
    }
    for (const std::string& note : laid.notes()) fmt::print(stderr, "note: {}\n", note);
    if (choice.json) fmt::print("{}\n", json_of(choice, laid.fit(), others).dump(2));
    else {
        fmt::print("{} on {}: median {:.2f} mm, 90 % within {:.2f} mm\n", target_words(choice), choice.names[0],
                   laid.fit().registration.median * 1e3, laid.fit().registration.p90 * 1e3);
        if (is_refused) fmt::print("! {}\n", doubt_words(choice));
    }
    return is_refused ? answer_is_no : done;
}

Action declare_plan_mirror(VerbOptions& verb) {
    const auto choice = std::make_shared<MirrorChoice>();
    add_plan_options(verb, *choice);
    verb.add("healthy", choice->healthy, "bone file or mesh of the other side, or of the same side").required();
    add_fragments(verb, *choice, "the fixed fragment; further fragments are compared, or moved with --settle");
    verb.flag("--same-side", choice->same_side,
              "do not mirror: the bone is of the same side, as that of another person or of an earlier scan");
    verb.add("--max-residual", choice->max_residual, "mm, largest median distance from the fixed fragment")
        .range(0.1, 20.0)
        .shows_default();
    verb.flag("--settle", choice->settle, "move the other fragments to their best pose on the target");
    return [choice] { return mirror(*choice); };
}

}  // namespace

Verb plan_mirror_verb() {
    return {"mirror",
            "register the mirrored healthy side, or another bone, to a fragment, as a target; 1: the target is too far "
            "from the fragment",
            declare_plan_mirror};
}

}  // namespace tactus::command
