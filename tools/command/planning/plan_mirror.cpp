// SPDX-License-Identifier: Apache-2.0
// The healthy side of a plan's case: mirrored, laid on the main fragment, and the others compared with it.
#include "dsp/core/error.hpp"
#include "dsp/planning/gap.hpp"
#include "dsp/planning/mirror.hpp"
#include "tools/study/planning/plan_case.hpp"
#include "tools/plan_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <numbers>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

/// What a place by the healthy side means for the fracture itself.
Json faces_json(const CaseFragment& moving, const Pose& at, const CaseFragment& main, const Pose& stands) {
    const SurfaceGap gap = gap_between(moving.bone.points, at, main.map, stands);
    return {{"contact_mm2", gap.contact_area * 1e6},
            {"gap_median_mm", gap.median * 1e3},
            {"deepest_mm", gap.deepest * 1e3},
            {"overlap_mm3", overlap_volume(moving.bone.distance, at, main.map, stands) * 1e9}};
}

}  // namespace

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
    const RegistrationTarget surface(mirrored(healthy, fit.plane, target.pose));
    Json others = Json::array();
    for (std::size_t n = 1; n < numbers.size(); ++n) {
        const int other = numbers[n];
        const Pose from = state_of(plan).arrangement.pose(other);
        RegistrationSettings settings;
        settings.widest = 10e-3;
        const Registration found = register_surface(points(other), surface, from, settings);
        const Json motion = motion_json<Json>(from, found.pose, points(other));
        const CaseFragment &main = loaded[static_cast<std::size_t>(numbers[0])],
                           &moved = loaded[static_cast<std::size_t>(other)];
        const Json faces{{"before", faces_json(moved, from, main, stands)},
                         {"after", faces_json(moved, found.pose, main, stands)}};
        others.push_back({{"fragment", choice.names[n]},
                          {"away", motion},
                          {"median_before_mm", found.before * 1e3},
                          {"median_after_mm", found.median * 1e3},
                          {"faces", faces},
                          {"pose", pose_json<Json>(found.pose)}});
        if (!choice.json)
            fmt::print(
                "{}: {:.2f} mm and {:.2f}° from where it lies best on the target; median {:.2f} mm, there "
                "{:.2f} mm\n",
                choice.names[n], motion["distance_mm"].get<double>(), motion["angle_deg"].get<double>(),
                found.before * 1e3, found.median * 1e3);
        for (const char* when : {"before", "after"})
            if (!choice.json)
                fmt::print("  {} {}: {:.0f} mm² touch {}, {:.0f} mm³ in each other, {:.2f} mm deep\n", choice.names[n],
                           when == std::string_view("before") ? "where it was" : "there",
                           faces[when]["contact_mm2"].get<double>(), choice.names[0],
                           faces[when]["overlap_mm3"].get<double>(), faces[when]["deepest_mm"].get<double>());
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

}  // namespace tactus
