// SPDX-License-Identifier: Apache-2.0
// Where fragments of a plan belong by their own fractures.
#include "dsp/core/error.hpp"
#include "dsp/planning/as_scanned.hpp"
#include "dsp/planning/fragment_matcher.hpp"
#include "dsp/planning/gap.hpp"
#include "tools/study/bones/intact_side.hpp"
#include "tools/study/planning/plan_case.hpp"
#include "tools/plan_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

PlanFit record_of(const FragmentMatch& match, const std::string& partner) {
    const FitQuality& q = match.quality;
    return {partner,  std::string(name_of(match.verdict)), q.score, match.margin, q.rms, q.gap, q.penetration,
            q.overlap};
}

/// The fragments of a plan, and the matcher that looks at them.
struct Matching {
    std::vector<CaseFragment> loaded;
    std::vector<FragmentSurface> surfaces;
    std::unique_ptr<FragmentMatcher> matcher;

    Matching(const CasePlan& plan, const std::filesystem::path& folder)
        : loaded(load_fragments(plan, folder, Paint::or_proposed)) {
        for (const CaseFragment& f : loaded) surfaces.push_back({f.bone.points, &f.bone.distance});
        MatcherSettings settings;
        settings.most_points = 2000;
        matcher = std::make_unique<FragmentMatcher>(surfaces, settings);
    }

    /// A fit that only repeats the scan says nothing of where the fragment belongs.
    bool repeats_scan(const FragmentMatch& match, std::span<const Pose> poses) const {
        if (match.verdict != FitVerdict::fit) return false;
        const auto moving = static_cast<std::size_t>(match.moving), partner = static_cast<std::size_t>(match.partner);
        return is_as_scanned(loaded[moving].bone.points, poses[partner].inverse() * match.pose, loaded[partner].map);
    }
};

std::vector<Pose> poses_of(const Arrangement& a) {
    std::vector<Pose> poses;
    for (int n = 0; n < static_cast<int>(a.size()); ++n) poses.push_back(a.pose(n));
    return poses;
}

/// All that is shown and does not move along; or one of them alone.
std::vector<char> partners_of(const Arrangement& a, int moving, int only) {
    std::vector<char> stands;
    for (int n = 0; n < static_cast<int>(a.size()); ++n)
        stands.push_back(!a.move_together(moving, n) && (only == Arrangement::none ? !a.is_hidden(n) : n == only));
    return stands;
}

/// What was found for a fragment, and what is held against it.
struct Found {
    FragmentMatch match;
    bool as_scanned = false;

    Found(const FragmentMatch& made, const Matching& matching, std::span<const Pose> poses)
        : match(made), as_scanned(matching.repeats_scan(made, poses)) {
        if (as_scanned) match.verdict = FitVerdict::ambiguous;
    }
};

Json match_json(const CasePlan& plan, const Found& found, const Pose& from, const CaseFragment& fragment) {
    const FragmentMatch& match = found.match;
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    return {{"fragment", name(match.moving)},
            {"partner", match.partner == Arrangement::none ? Json(nullptr) : Json(name(match.partner))},
            {"verdict", name_of(match.verdict)},
            {"placed", match.verdict == FitVerdict::fit},
            {"as_scanned", found.as_scanned},
            {"faces", match.faces},
            {"score", match.quality.score},
            {"margin", match.margin},
            {"rms_mm", match.quality.rms * 1e3},
            {"gap_mm", match.quality.gap * 1e3},
            {"penetration_mm", match.quality.penetration * 1e3},
            {"overlap_mm2", match.quality.overlap * 1e6},
            {"pose", pose_json<Json>(match.pose)},
            {"moved", motion_json<Json>(from, match.pose, fragment.bone.points)},
            {"paint", fragment.was_painted ? "file" : "proposed"}};
}

/// One line for people.
void say(const CasePlan& plan, const Found& found) {
    const FragmentMatch& match = found.match;
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    if (match.partner == Arrangement::none) fmt::print("{}: nothing near looks against it\n", name(match.moving));
    else
        fmt::print("{} to {}: {}, {} faces, score {:.2f}, margin {:.2f}, {:.0f} mm² on each other, {:.3f} mm rms{}\n",
                   name(match.moving), name(match.partner), name_of(match.verdict), match.faces, match.quality.score,
                   match.margin, match.quality.overlap * 1e6, match.quality.rms * 1e3,
                   match.verdict == FitVerdict::fit ? "" : "; it stays where it was");
    if (found.as_scanned) fmt::print("{}\n", as_scanned_note);
}

/// The other residual, when the plan has a healthy side: of the whole fragment from that, mm.
Json target_json(const PlanState& state, const std::filesystem::path& folder, const CaseFragment& fragment,
                 const Pose& from, const Pose& there) {
    if (!state.mirror) return nullptr;
    const RegistrationTarget target(laid_target(*state.mirror, folder));
    return {{"median_before_mm", 1e3 * median_distance(fragment.bone.points, target, from)},
            {"median_there_mm", 1e3 * median_distance(fragment.bone.points, target, there)}};
}

PlanStep step_of(const CasePlan& plan, const FragmentMatch& match, const char* by) {
    PlanStep step = placing(plan, match.moving, match.pose, by);
    step.fit = record_of(match, plan.fragments[static_cast<std::size_t>(match.partner)].name);
    return step;
}

}  // namespace

int plan_snap(const PlanChoice& choice) {
    OpenPlan open(choice.plan);
    CasePlan& plan = open.plan;
    const int moving = find_fragment(plan, choice.names[0]);
    const int only = choice.names.size() > 1 ? find_fragment(plan, choice.names[1]) : Arrangement::none;
    const PlanState state = state_of(plan);
    const Arrangement& a = state.arrangement;
    if (only != Arrangement::none && a.move_together(moving, only))
        throw Error(fmt::format("'{}' and '{}' move together", choice.names[0], choice.names[1]));
    if (!a.can_move(moving)) throw Error(fmt::format("'{}', or one grouped with it, is locked", choice.names[0]));
    Matching matching(plan, choice.plan.parent_path());
    FragmentMatcher& matcher = *matching.matcher;
    if (matcher.faces_of(moving) == 0)
        throw Error(
            fmt::format("fragment '{}' has no painted fracture; see 'tactus fracture-surface'", choice.names[0]));
    const auto poses = poses_of(a);
    const auto stands = partners_of(a, moving, only);
    FragmentMatch match = matcher.near(moving, poses, stands);
    if (choice.mode == "global") {
        matcher.begin_search();
        do match = matcher.search(moving, poses, stands);
        while (matcher.left() > 0);
    }
    const Found found(match, matching, poses);
    const bool fits = found.match.verdict == FitVerdict::fit;
    const CaseFragment& fragment = matching.loaded[static_cast<std::size_t>(moving)];
    // What may fail comes before the plan is changed.
    const Json target = target_json(state, choice.plan.parent_path(), fragment, a.pose(moving), found.match.pose);
    if (fits) do_step(plan, step_of(plan, found.match, "snap"), choice.plan);
    if (choice.json) {
        Json json = match_json(plan, found, a.pose(moving), fragment);
        if (!target.is_null()) json["target"] = target;
        fmt::print("{}\n", json.dump(2));
    } else {
        say(plan, found);
        if (!target.is_null())
            fmt::print("from the healthy side: median {:.2f} mm where it was, {:.2f} mm where its faces fit\n",
                       target["median_before_mm"].get<double>(), target["median_there_mm"].get<double>());
    }
    return fits ? done : answer_is_no;
}

int plan_settle(const PlanChoice& choice) {
    OpenPlan open(choice.plan);
    CasePlan& plan = open.plan;
    std::vector<int> numbers;
    for (const std::string& name : choice.names) numbers.push_back(find_fragment(plan, name));
    if (numbers.empty()) {
        const PlanState state = state_of(plan);
        for (int n = 0; n < static_cast<int>(plan.fragments.size()); ++n)
            if (state.fits[static_cast<std::size_t>(n)] && state.arrangement.can_move(n)) numbers.push_back(n);
    }
    if (numbers.empty()) throw Error("nothing was fitted yet; 'tactus plan snap' comes first");
    Matching matching(plan, choice.plan.parent_path());
    Json rows = Json::array();
    for (int pass = 0; pass < choice.steps; ++pass)
        for (const int n : numbers) {
            const Arrangement a = state_of(plan).arrangement;
            const auto poses = poses_of(a);
            const Found found(matching.matcher->near(n, poses, partners_of(a, n, Arrangement::none)), matching, poses);
            if (found.match.verdict == FitVerdict::fit)
                do_step(plan, step_of(plan, found.match, "settle"), choice.plan);
            rows.push_back(match_json(plan, found, a.pose(n), matching.loaded[static_cast<std::size_t>(n)]));
            if (!choice.json) say(plan, found);
        }
    if (choice.json) fmt::print("{}\n", rows.dump(2));
    return std::ranges::all_of(rows, [](const Json& row) { return row["placed"] == true; }) ? done : answer_is_no;
}

int plan_gap(const PlanChoice& choice) {
    const CasePlan plan = load_case_plan(choice.plan);
    if (!choice.names.empty() && choice.names.size() != 2) throw Error("'plan gap' takes two fragments, or none");
    const std::vector<CaseFragment> loaded = load_fragments(plan, choice.plan.parent_path());
    const PlanState state = state_of(plan);
    Json pairs = Json::array();
    const auto look = [&](int i, int j) {
        const CaseFragment &a = loaded[static_cast<std::size_t>(i)], &b = loaded[static_cast<std::size_t>(j)];
        const Pose &at = state.arrangement.pose(i), &bt = state.arrangement.pose(j);
        const SurfaceGap gap = gap_between(a.bone.points, at, b.map, bt);
        if (choice.names.empty() && !(gap.facing_area > 5e-6)) return;
        pairs.push_back(
            {{"fragments",
              {plan.fragments[static_cast<std::size_t>(i)].name, plan.fragments[static_cast<std::size_t>(j)].name}},
             {"facing_mm2", gap.facing_area * 1e6},
             {"contact_mm2", gap.contact_area * 1e6},
             {"gap_median_mm", gap.median * 1e3},
             {"gap_p95_mm", gap.p95 * 1e3},
             {"deepest_mm", gap.deepest * 1e3},
             {"overlap_mm3", overlap_volume(a.bone.distance, at, b.map, bt) * 1e9}});
    };
    if (choice.names.size() == 2) look(find_fragment(plan, choice.names[0]), find_fragment(plan, choice.names[1]));
    else
        for (int i = 0; i < static_cast<int>(loaded.size()); ++i)
            for (int j = i + 1; j < static_cast<int>(loaded.size()); ++j)
                if (!state.arrangement.is_hidden(i) && !state.arrangement.is_hidden(j)) look(i, j);
    if (choice.json) fmt::print("{}\n", pairs.dump(2));
    else
        for (const Json& p : pairs)
            fmt::print(
                "{} and {}: {:.0f} mm² face each other, {:.0f} mm² touch; gap {:.2f} mm (95 %: {:.2f} mm), "
                "{:.1f} mm³ in each other, {:.2f} mm deep\n",
                p["fragments"][0].get<std::string>(), p["fragments"][1].get<std::string>(),
                p["facing_mm2"].get<double>(), p["contact_mm2"].get<double>(),
                shown_mm(p["gap_median_mm"].get<double>()), p["gap_p95_mm"].get<double>(),
                p["overlap_mm3"].get<double>(), p["deepest_mm"].get<double>());
    return done;
}

}  // namespace tactus
