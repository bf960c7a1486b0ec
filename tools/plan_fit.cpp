// SPDX-License-Identifier: Apache-2.0
// Where fragments of a plan belong: by their own fractures, and by the healthy side.
#include "dsp/core/error.hpp"
#include "dsp/planning/fragment_matcher.hpp"
#include "dsp/planning/gap.hpp"
#include "dsp/planning/mirror.hpp"
#include "tools/plan_case.hpp"
#include "tools/plan_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <numbers>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

PlanFit record_of(const FragmentMatch& match, const std::string& partner) {
    const FitQuality& q = match.quality;
    return {partner,  std::string(name_of(match.verdict)), q.score, match.margin, q.rms, q.gap, q.penetration,
            q.overlap};
}

/// Motion of the fragment's middle, mm and degrees.
Json motion_json(const Pose& from, const Pose& to, const CaseFragment& fragment) {
    Vec3 middle(0.0);
    for (const SurfacePoint& p : fragment.bone.points)
        middle += p.position / static_cast<double>(fragment.bone.points.size());
    return {{"distance_mm", 1e3 * glm::length(to.apply(middle) - from.apply(middle))},
            {"angle_deg", angle_deg(to * from.inverse())}};
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

Json match_json(const CasePlan& plan, const FragmentMatch& match, const Pose& from, const CaseFragment& fragment) {
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    return {{"fragment", name(match.moving)},
            {"partner", match.partner == Arrangement::none ? Json(nullptr) : Json(name(match.partner))},
            {"verdict", name_of(match.verdict)},
            {"placed", match.verdict == FitVerdict::fit},
            {"faces", match.faces},
            {"score", match.quality.score},
            {"margin", match.margin},
            {"rms_mm", match.quality.rms * 1e3},
            {"gap_mm", match.quality.gap * 1e3},
            {"penetration_mm", match.quality.penetration * 1e3},
            {"overlap_mm2", match.quality.overlap * 1e6},
            {"pose", pose_json<Json>(match.pose)},
            {"moved", motion_json(from, match.pose, fragment)},
            {"paint", fragment.was_painted ? "file" : "proposed"}};
}

/// One line for people.
void say(const CasePlan& plan, const FragmentMatch& match) {
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    if (match.partner == Arrangement::none) fmt::print("{}: nothing near looks against it\n", name(match.moving));
    else
        fmt::print("{} to {}: {}, {} faces, score {:.2f}, margin {:.2f}, {:.0f} mm² on each other, {:.3f} mm rms{}\n",
                   name(match.moving), name(match.partner), name_of(match.verdict), match.faces, match.quality.score,
                   match.margin, match.quality.overlap * 1e6, match.quality.rms * 1e3,
                   match.verdict == FitVerdict::fit ? "" : "; it stays where it was");
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
    const Arrangement a = state_of(plan).arrangement;
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
    if (match.verdict == FitVerdict::fit) do_step(plan, step_of(plan, match, "snap"), choice.plan);
    if (choice.json)
        fmt::print("{}\n",
                   match_json(plan, match, a.pose(moving), matching.loaded[static_cast<std::size_t>(moving)]).dump(2));
    else say(plan, match);
    return match.verdict == FitVerdict::fit ? done : answer_is_no;
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
            const FragmentMatch match = matching.matcher->near(n, poses_of(a), partners_of(a, n, Arrangement::none));
            if (match.verdict == FitVerdict::fit) do_step(plan, step_of(plan, match, "settle"), choice.plan);
            rows.push_back(match_json(plan, match, a.pose(n), matching.loaded[static_cast<std::size_t>(n)]));
            if (!choice.json) say(plan, match);
        }
    if (choice.json) fmt::print("{}\n", rows.dump(2));
    return std::ranges::all_of(rows, [](const Json& row) { return row["placed"] == true; }) ? done : answer_is_no;
}

int plan_mirror(const PlanChoice& choice) {
    OpenPlan open(choice.plan);
    CasePlan& plan = open.plan;
    const std::filesystem::path folder = choice.plan.parent_path();
    std::vector<int> numbers;
    for (const std::string& name : choice.names) numbers.push_back(find_fragment(plan, name));
    const std::vector<SurfacePoint> healthy = points_of_file(choice.healthy);
    const std::vector<CaseFragment> loaded = load_fragments(plan, folder);
    const auto points = [&](int n) -> const std::vector<SurfacePoint>& {
        return loaded[static_cast<std::size_t>(n)].bone.points;
    };
    const MirrorFit fit = fit_mirror(healthy, points(numbers[0]));
    MirrorTarget target;
    CasePlan named;
    add_fragment(named, "healthy", choice.healthy, folder, Vec3(0.0));
    target.file = named.fragments[0].file;
    target.hash = named.fragments[0].hash;
    target.plane_normal = fit.plane.normal;
    target.plane_offset = fit.plane.offset;
    const Pose stands = state_of(plan).arrangement.pose(numbers[0]);
    target.pose = stands * fit.pose;
    target.residual = fit.registration.median;
    PlanStep step;
    step.kind = StepKind::mirror;
    step.by = "command";
    step.mirror = target;
    do_step(plan, std::move(step), choice.plan);
    // The others against the mirrored side as it lies now.
    std::vector<SurfacePoint> laid = mirrored(healthy, fit.plane);
    for (SurfacePoint& p : laid) {
        p.position = target.pose.apply(p.position);
        p.normal = target.pose.rotate(p.normal);
    }
    const RegistrationTarget surface(laid);
    Json others = Json::array();
    for (std::size_t n = 1; n < numbers.size(); ++n) {
        const int other = numbers[n];
        const Pose from = state_of(plan).arrangement.pose(other);
        RegistrationSettings settings;
        settings.widest = 10e-3;
        const Registration found = register_surface(points(other), surface, from, settings);
        const Json motion = motion_json(from, found.pose, loaded[static_cast<std::size_t>(other)]);
        others.push_back({{"fragment", choice.names[n]},
                          {"away", motion},
                          {"median_before_mm", found.before * 1e3},
                          {"median_after_mm", found.median * 1e3},
                          {"pose", pose_json<Json>(found.pose)}});
        if (!choice.json)
            fmt::print(
                "{}: {:.2f} mm and {:.2f}° from where it lies best on the target; median {:.2f} mm, there "
                "{:.2f} mm\n",
                choice.names[n], motion["distance_mm"].get<double>(), motion["angle_deg"].get<double>(),
                found.before * 1e3, found.median * 1e3);
        if (choice.settle) do_step(plan, placing(plan, other, found.pose, "mirror"), choice.plan);
    }
    if (choice.json)
        fmt::print(
            "{}\n",
            Json{{"on", choice.names[0]},
                 {"residual_mm", fit.registration.median * 1e3},
                 {"residual_p90_mm", fit.registration.p90 * 1e3},
                 {"plane_normal", {fit.plane.normal.x, fit.plane.normal.y, fit.plane.normal.z}},
                 {"plane_offset_mm", fit.plane.offset * 1e3},
                 {"asymmetry", {{"angle_deg", fit.turn * 180.0 / std::numbers::pi}, {"distance_mm", fit.glide * 1e3}}},
                 {"others", others}}
                .dump(2));
    else
        fmt::print("mirrored side on {}: median {:.2f} mm, 90 % within {:.2f} mm\n", choice.names[0],
                   fit.registration.median * 1e3, fit.registration.p90 * 1e3);
    return done;
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
