// SPDX-License-Identifier: Apache-2.0
// Lays one surface on another of the same shape, whole or the part of it that is elsewhere.
#include "dsp/core/error.hpp"
#include "dsp/planning/mirror.hpp"
#include "tools/plan_case.hpp"
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

/// The part that is not where the rest has it, laid on its place by itself.
Json region_json(const std::vector<SurfacePoint>& moving, const Registration& bulk, const RegistrationTarget& target,
                 const RegisterChoice& choice) {
    const auto region =
        displaced_region(moving, bulk.pose, target, choice.away * 1e-3, choice.gap * 1e-3, choice.margin * 1e-3);
    if (region.empty()) return nullptr;
    std::vector<SurfacePoint> part;
    Vec3 middle(0.0);
    double area = 0.0;
    for (const std::size_t n : region) {
        part.push_back(moving[n]);
        middle += moving[n].area * moving[n].position;
        area += moving[n].area;
    }
    middle /= area;
    const Registration own = register_surface(part, target, bulk.pose, {.widest = 8e-3, .finest = 0.8e-3});
    Json json = json_of(own);
    json["points"] = region.size();
    json["area_mm2"] = area * 1e6;
    json["away"] = {{"distance_mm", 1e3 * glm::length(own.pose.apply(middle) - bulk.pose.apply(middle))},
                    {"angle_deg", angle_deg(own.pose * bulk.pose.inverse())}};
    return json;
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
        const Registration bulk =
            choice.anywhere ? register_from_anywhere(moving, fixed, target) : register_surface(moving, target, {});
        json = json_of(bulk);
        if (choice.region) json["region"] = region_json(moving, bulk, target, choice);
    }
    if (choice.json) fmt::print("{}\n", json.dump(2));
    else {
        fmt::print("median distance {:.2f} mm (before {:.2f} mm), 90 % within {:.2f} mm\n",
                   json["median_mm"].get<double>(), json["median_before_mm"].get<double>(),
                   json["p90_mm"].get<double>());
        if (json.contains("region") && !json["region"].is_null())
            fmt::print("a region of {:.0f} mm² lies {:.2f} mm and {:.2f}° from where it fits by itself\n",
                       json["region"]["area_mm2"].get<double>(), json["region"]["away"]["distance_mm"].get<double>(),
                       json["region"]["away"]["angle_deg"].get<double>());
        else if (choice.region) fmt::print("no part of it lies elsewhere\n");
    }
    return done;
}

}  // namespace tactus
