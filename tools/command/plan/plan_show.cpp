// SPDX-License-Identifier: Apache-2.0
// tactus plan show: the content of a plan as text or JSON.
#include "assets/file/json.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/analysis/plan/plan_vessels.hpp"
#include "tools/analysis/plan/plan_words.hpp"
#include "tools/analysis/plan/target_deviation.hpp"
#include "tools/command/plan/flap_text.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/command/pose_text.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <numbers>

namespace tactus::command {

namespace {

using file::Json;

/// The groups that hold a fragment, innermost first.
std::vector<std::string> groups_of(const plan::PlanState& state, int fragment) {
    std::vector<std::string> names;
    for (int g = state.arrangement.group_of(fragment); g != fit::Arrangement::none; g = state.arrangement.parent_of(g))
        names.push_back(state.group_names[static_cast<std::size_t>(g)]);
    return names;
}

/// `verdict` is "void" when the fragment or its partner has moved from the other since.
Json fit_json(const plan::PlanState& state, int fragment) {
    const plan::PlanFit& fit = *state.fits[static_cast<std::size_t>(fragment)];
    const fit::Arrangement::Departure away = state.arrangement.departure(fragment);
    return {
        {"partner", fit.partner},
        {"verdict", state.holds(fragment) ? fit.verdict : "void"},
        {"moved_since", {{"distance_mm", away.distance * 1e3}, {"angle_deg", away.angle * 180.0 / std::numbers::pi}}},
        {"score", fit.score},
        {"margin", fit.margin},
        {"rms_mm", fit.rms * 1e3},
        {"gap_mm", fit.gap * 1e3},
        {"penetration_mm", fit.penetration * 1e3},
        {"overlap_mm2", fit.overlap * 1e6}};
}

Json json_of(const plan::CasePlan& plan, const analysis::CaseWarnings& warnings,
             const std::vector<analysis::NamedDeviation>& deviation) {
    Json problems = Json::array();
    for (const analysis::CaseWarning& warning : warnings.all)
        if (warning.code == "changed-file") problems.push_back(warning.text);
    const plan::PlanState state = plan::state_of(plan);
    const auto before = plan.before();
    Json json{{"title", plan.title},
              {"fragments", Json::array()},
              {"groups", Json::array()},
              {"alternatives", Json::array()},
              {"current", plan.alternatives[static_cast<std::size_t>(plan.current)].name},
              {"steps_done", fit::steps_to(before, plan.place().head).size()},
              {"steps_to_redo",
               fit::steps_to(before, plan.place().tip).size() - fit::steps_to(before, plan.place().head).size()},
              {"steps_in_all", plan.steps.size()},
              {"mirror", nullptr},
              {"assemblies", analysis::assembly_names(plan, state)},
              {"problems", problems},
              {"warnings", analysis::json_of(warnings.all)},
              {"measured", warnings.is_measured}};
    for (int n = 0; n < static_cast<int>(plan.fragments.size()); ++n) {
        const plan::PlanFragment& f = plan.fragments[static_cast<std::size_t>(n)];
        Json fragment{{"name", f.name},
                      {"file", state.files[static_cast<std::size_t>(n)].file},
                      {"pose", pose_json<Json>(state.arrangement.pose(n))},
                      {"groups", groups_of(state, n)},
                      {"locked", state.arrangement.is_locked(n)},
                      {"hidden", state.arrangement.is_hidden(n)},
                      {"fit", nullptr}};
        if (state.fits[static_cast<std::size_t>(n)]) fragment["fit"] = fit_json(state, n);
        json["fragments"].push_back(fragment);
    }
    for (int g = 0; g < static_cast<int>(state.arrangement.max_groups()); ++g) {
        if (!state.arrangement.exists(g)) continue;
        const int parent = state.arrangement.parent_of(g);
        json["groups"].push_back(
            {{"name", state.group_names[static_cast<std::size_t>(g)]},
             {"in", parent == fit::Arrangement::none ? Json(nullptr)
                                                     : Json(state.group_names[static_cast<std::size_t>(parent)])}});
    }
    for (const plan::PlanAlternative& a : plan.alternatives)
        json["alternatives"].push_back({{"name", a.name}, {"steps", fit::steps_to(before, a.place.head).size()}});
    if (state.reconstruction) json["reconstruction"] = reconstruction_json(*state.reconstruction);
    if (!deviation.empty()) json["deviation"] = analysis::deviation_json(deviation);
    json["vessels"] = Json::array();
    if (state.vessels)
        for (const reconstruction::FlapVessel& v : *state.vessels)
            json["vessels"].push_back({{"name", v.name},
                                       {"kind", reconstruction::name_of(v.kind)},
                                       {"length_mm", analysis::length_of(v) * 1e3},
                                       {"radius_mm", v.radius * 1e3}});
    if (state.mirror)
        json["mirror"] = {{"file", state.mirror->file},
                          {"mirrored", state.mirror->is_mirrored},
                          {"plane_normal",
                           {state.mirror->plane_normal.x, state.mirror->plane_normal.y, state.mirror->plane_normal.z}},
                          {"plane_offset_mm", state.mirror->plane_offset * 1e3},
                          {"residual_mm", state.mirror->residual * 1e3}};
    return json;
}

}  // namespace

int show_plan(const PlanChoice& choice) {
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const analysis::CaseWarnings warnings = analysis::known_warnings(plan, choice.plan.parent_path());
    const auto deviation = analysis::deviation_from_target(plan, choice.plan.parent_path());
    if (choice.json) {
        fmt::print("{}\n", json_of(plan, warnings, deviation).dump(2));
        return done;
    }
    const plan::PlanState state = plan::state_of(plan);
    const auto before = plan.before();
    fmt::print("{}: alternative '{}' of {}, {} done, {} to redo\n", plan.title,
               plan.alternatives[static_cast<std::size_t>(plan.current)].name, plan.alternatives.size(),
               counted(fit::steps_to(before, plan.place().head).size(), "step"),
               fit::steps_to(before, plan.place().tip).size() - fit::steps_to(before, plan.place().head).size());
    for (int n = 0; n < static_cast<int>(plan.fragments.size()); ++n) {
        const plan::PlanFragment& f = plan.fragments[static_cast<std::size_t>(n)];
        const Pose& pose = state.arrangement.pose(n);
        std::string marks = state.arrangement.is_locked(n) ? ", locked" : "";
        if (state.arrangement.is_hidden(n)) marks += ", hidden";
        for (const std::string& group : groups_of(state, n)) marks += fmt::format(", in '{}'", group);
        if (const std::string fit = analysis::fit_words(state, n); !fit.empty()) marks += ", " + fit;
        fmt::print("  {}: at {:.2f} {:.2f} {:.2f} mm, turned {:.2f}°{}\n", f.name, pose.position.x * 1e3,
                   pose.position.y * 1e3, pose.position.z * 1e3, analysis::angle_deg(pose), marks);
    }
    if (state.vessels)
        for (const reconstruction::FlapVessel& v : *state.vessels)
            fmt::print("  {}: {}, {:.1f} mm long, radius {:.2f} mm\n", v.name, reconstruction::name_of(v.kind),
                       analysis::length_of(v) * 1e3, v.radius * 1e3);
    if (state.reconstruction) print_reconstruction(*state.reconstruction);
    for (const analysis::NamedDeviation& one : deviation) fmt::print("  {}\n", analysis::deviation_words(one));
    if (!state.reconstruction)
        for (const std::string& line : analysis::connection_words(plan, state)) fmt::print("  {}\n", line);
    print_warnings(warnings);
    if (!warnings.is_measured)
        fmt::print("not measured for this version of the plan: overlaps{}; 'tactus plan check' does\n",
                   state.reconstruction ? ", vessels, hardware" : "");
    return done;
}

Verb plan_show_verb() {
    return {"show", "show fragments, groups, alternatives, and problems of the files", [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<PlanChoice>();
                add_plan_options(verb, *choice);
                return [choice] { return show_plan(*choice); };
            }};
}

}  // namespace tactus::command
