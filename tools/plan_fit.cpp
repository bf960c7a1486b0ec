// SPDX-License-Identifier: Apache-2.0
// Where fragments of a plan belong: by their own fractures, and by the healthy side.
#include "dsp/core/error.hpp"
#include "dsp/planning/gap.hpp"
#include "dsp/planning/mirror.hpp"
#include "dsp/snap/fit.hpp"
#include "tools/plan_case.hpp"
#include "tools/plan_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

constexpr double near = 25e-3;  // m: from where it is, a fragment is not brought to one farther away

/// Least distance between the points of two placed bones, every so many-th of the first tried.
double apart(const CaseFragment& a, const Pose& at, const CaseFragment& b, const Pose& bt) {
    const Pose into = bt.inverse() * at;
    const RegistrationTarget target(b.bone.points);
    double least = std::numeric_limits<double>::infinity();
    const std::size_t stride = std::max<std::size_t>(1, a.bone.points.size() / 500);
    for (std::size_t n = 0; n < a.bone.points.size(); n += stride) {
        const Vec3 x = into.apply(a.bone.points[n].position);
        least = std::min(least, glm::length(x - target.position(target.nearest(x))));
    }
    return least;
}

std::vector<FitSurface> faces_of(const CaseFragment& fragment, const std::string& name) {
    try {
        return make_fit_faces(fragment.bone.points, fragment.bone.distance);
    } catch (const Error& error) {
        throw Error(fmt::format("fragment '{}': {}", name, error.message()));
    }
}

PlanFit record_of(const Fit& fit, const std::string& partner) {
    return {partner,         std::string(name_of(fit.verdict)), fit.quality.score,  fit.margin, fit.quality.rms,
            fit.quality.gap, fit.quality.penetration,           fit.quality.overlap};
}

/// What a fit is worth beside others: one that holds before one that does not, and a larger area before a smaller.
double worth(const Fit& fit) {
    return (fit.verdict == FitVerdict::fit ? 1.0 : 1e-3) * fit.quality.score * std::sqrt(fit.quality.overlap);
}

/// Motion of the fragment's middle, mm and degrees.
Json motion_json(const Pose& from, const Pose& to, const CaseFragment& fragment) {
    Vec3 middle(0.0);
    for (const SurfacePoint& p : fragment.bone.points)
        middle += p.position / static_cast<double>(fragment.bone.points.size());
    return {{"distance_mm", 1e3 * glm::length(to.apply(middle) - from.apply(middle))},
            {"angle_deg", angle_deg(to * from.inverse())}};
}

}  // namespace

int plan_snap(const PlanChoice& choice) {
    CasePlan plan = load_case_plan(choice.plan);
    const std::filesystem::path folder = choice.plan.parent_path();
    const int moving = find_fragment(plan, choice.names[0]);
    const int only = choice.names.size() > 1 ? find_fragment(plan, choice.names[1]) : Arrangement::none;
    const PlanState state = state_of(plan);
    const Arrangement& a = state.arrangement;
    if (only != Arrangement::none && a.move_together(moving, only))
        throw Error(fmt::format("'{}' and '{}' move together", choice.names[0], choice.names[1]));
    if (!a.can_move(moving)) throw Error(fmt::format("'{}', or one grouped with it, is locked", choice.names[0]));
    const std::vector<CaseFragment> loaded = load_fragments(plan, folder);
    const auto fragment = [&](int n) -> const CaseFragment& { return loaded[static_cast<std::size_t>(n)]; };
    const auto name = [&](int n) -> const std::string& { return plan.fragments[static_cast<std::size_t>(n)].name; };
    const FitMode mode = choice.mode == "global" ? FitMode::global : FitMode::extended;
    const std::vector<FitSurface> faces = faces_of(fragment(moving), name(moving));
    std::optional<Fit> best;
    int partner = Arrangement::none;
    for (int other = 0; other < static_cast<int>(a.size()); ++other) {
        if (only != Arrangement::none ? other != only : a.is_hidden(other) || a.move_together(moving, other)) continue;
        if (only == Arrangement::none && mode == FitMode::extended &&
            apart(fragment(moving), a.pose(moving), fragment(other), a.pose(other)) > near)
            continue;
        const Fit fit =
            find_fit(faces, faces_of(fragment(other), name(other)), a.pose(other).inverse() * a.pose(moving), mode);
        if (best && !(worth(fit) > worth(*best))) continue;
        best = fit;
        partner = other;
    }
    if (!best)
        throw Error(fmt::format("nothing that is shown lies within {:.0f} mm of '{}'", near * 1e3, name(moving)));
    const Pose to = a.pose(partner) * best->pose;
    if (best->verdict == FitVerdict::fit) {
        PlanStep step = placing(plan, moving, to, "snap");
        step.fit = record_of(*best, name(partner));
        do_step(plan, std::move(step), choice.plan);
    }
    if (choice.json) {
        Json json{{"fragment", name(moving)},
                  {"partner", name(partner)},
                  {"verdict", name_of(best->verdict)},
                  {"placed", best->verdict == FitVerdict::fit},
                  {"score", best->quality.score},
                  {"margin", best->margin},
                  {"rms_mm", best->quality.rms * 1e3},
                  {"gap_mm", best->quality.gap * 1e3},
                  {"penetration_mm", best->quality.penetration * 1e3},
                  {"overlap_mm2", best->quality.overlap * 1e6},
                  {"pose", pose_json(to)},
                  {"moved", motion_json(a.pose(moving), to, fragment(moving))},
                  {"paint", fragment(moving).was_painted ? "file" : "proposed"}};
        fmt::print("{}\n", json.dump(2));
    } else
        fmt::print("{} to {}: {}, score {:.2f}, margin {:.2f}, {:.0f} mm² on each other, {:.3f} mm rms{}\n",
                   name(moving), name(partner), name_of(best->verdict), best->quality.score, best->margin,
                   best->quality.overlap * 1e6, best->quality.rms * 1e3,
                   best->verdict == FitVerdict::fit ? "" : "; it stays where it was");
    return best->verdict == FitVerdict::fit ? done : answer_is_no;
}

int plan_mirror(const PlanChoice& choice) {
    CasePlan plan = load_case_plan(choice.plan);
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
                          {"pose", pose_json(found.pose)}});
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
                p["facing_mm2"].get<double>(), p["contact_mm2"].get<double>(), p["gap_median_mm"].get<double>(),
                p["gap_p95_mm"].get<double>(), p["overlap_mm3"].get<double>(), p["deepest_mm"].get<double>());
    return done;
}

}  // namespace tactus
