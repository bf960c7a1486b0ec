// SPDX-License-Identifier: Apache-2.0
// Lays one surface on another of the same shape, whole or the part of it that is elsewhere.
#include "dsp/core/error.hpp"
#include "dsp/planning/mirror.hpp"
#include "dsp/planning/point_registration.hpp"
#include "tools/study/planning/plan_case.hpp"
#include "tools/snap_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <cmath>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Registration& r) {
    return {{"pose", pose_json<Json>(r.pose)},
            {"median_before_mm", r.before * 1e3},
            {"median_mm", r.median * 1e3},
            {"p90_mm", r.p90 * 1e3},
            {"covered", r.covered}};
}

struct Part {
    std::vector<SurfacePoint> points;
    Vec3 middle{0.0};
    double area = 0.0;
};

Part part_of(const std::vector<SurfacePoint>& moving, const std::vector<std::size_t>& region) {
    Part part;
    for (const std::size_t n : region) {
        part.points.push_back(moving[n]);
        part.middle += moving[n].area * moving[n].position;
        part.area += moving[n].area;
    }
    part.middle /= part.area;
    return part;
}

/// How far a part's middle moves, and how far it turns.
Json away_json(const Part& part, const Pose& from, const Pose& to) {
    return {{"distance_mm", 1e3 * glm::length(to.apply(part.middle) - from.apply(part.middle))},
            {"angle_deg", angle_deg(to * from.inverse())}};
}

/// The part that is not where the rest has it, laid on its place by itself, and what plain ICP of points says about it.
Json region_json(const std::vector<SurfacePoint>& moving, const Registration& bulk, const RegistrationTarget& target,
                 const RegisterChoice& choice) {
    const double away = choice.away * 1e-3, gap = choice.gap * 1e-3;
    auto region = displaced_region(moving, bulk.pose, target, away, gap, choice.margin * 1e-3);
    if (region.empty()) return nullptr;
    Part part = part_of(moving, region);
    const PointRegistration plain = register_points(part.points, target, bulk.pose);
    const Json plain_away = away_json(part, bulk.pose, plain.pose);
    Registration own = register_surface(part.points, target, bulk.pose, {.widest = 8e-3, .finest = 0.8e-3});
    // What slid along the surface is not far from it: now that the part's motion is known, all that moved with it counts.
    for (int round = 0; round < 2; ++round) {
        auto all = region_nearer(moving, bulk.pose, own.pose, target, 0.2 * away, away, gap);
        if (all.size() < region.size() / 2) break;
        region = std::move(all);
        part = part_of(moving, region);
        own = register_surface(part.points, target, own.pose, {.widest = 0.8e-3, .finest = 0.4e-3});
    }
    Json json = json_of(own);
    json["points"] = region.size();
    json["area_mm2"] = part.area * 1e6;
    json["away"] = away_json(part, bulk.pose, own.pose);
    json["point_to_point"] = {
        {"away", plain_away}, {"median_to_points_mm", plain.to_points * 1e3}, {"median_mm", plain.to_surface * 1e3}};
    return json;
}

void print_region(const Json& region) {
    const Json& plain = region["point_to_point"];
    fmt::print(
        "a region of {:.0f} mm² lies {:.2f} mm and {:.2f}° from where it fits by itself, median distance there {:.2f} "
        "mm\n(plain ICP of points: {:.2f} mm and {:.2f}°, median distance there {:.2f} mm)\n",
        region["area_mm2"].get<double>(), region["away"]["distance_mm"].get<double>(),
        region["away"]["angle_deg"].get<double>(), region["median_mm"].get<double>(),
        plain["away"]["distance_mm"].get<double>(), plain["away"]["angle_deg"].get<double>(),
        plain["median_mm"].get<double>());
}

}  // namespace

int register_verb(const RegisterChoice& choice) {
    const std::vector<SurfacePoint> fixed = points_of_file(choice.fixed);
    std::vector<SurfacePoint> moving = points_of_file(choice.moving);
    const RegistrationTarget target(fixed);
    Json json;
    if (choice.mirror) {
        const MirrorFit fit = fit_mirror(moving, fixed);
        json = json_of(fit.registration);
        json["pose"] = pose_json<Json>(fit.pose);
        json["plane_normal"] = {fit.plane.normal.x, fit.plane.normal.y, fit.plane.normal.z};
        json["plane_offset_mm"] = fit.plane.offset * 1e3;
    } else {
        const RegistrationSettings settings{.by_parts = choice.region};
        const Registration bulk = choice.anywhere ? register_from_anywhere(moving, fixed, target, settings)
                                                  : register_surface(moving, target, {}, settings);
        json = json_of(bulk);
        if (choice.region) json["region"] = region_json(moving, bulk, target, choice);
    }
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else {
        fmt::print("median distance {:.2f} mm (before {:.2f} mm), 90 % within {:.2f} mm\n",
                   json["median_mm"].get<double>(), json["median_before_mm"].get<double>(),
                   json["p90_mm"].get<double>());
        if (json.contains("region") && !json["region"].is_null()) print_region(json["region"]);
        else if (choice.region) fmt::print("no part of it lies elsewhere\n");
    }
    return done;
}

}  // namespace tactus
