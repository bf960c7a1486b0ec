// SPDX-License-Identifier: Apache-2.0
// tactus register: registers a surface to another one of the same shape, as a whole or by parts.
#include "assets/file/json.hpp"
#include "tools/analysis/bone/registration.hpp"
#include "tools/command/options.hpp"
#include "tools/command/pose_text.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <memory>
#include <string_view>

namespace tactus::command {

namespace {

using file::Json;

struct RegisterChoice {
    analysis::RegisterSettings settings;
    double away = 1.5, gap = 3.0, margin = 2.0;  // mm
    bool json = false;
};

Json json_of(const fit::Registration& r, const Pose& pose) {
    return {{"pose", pose_json<Json>(pose)},
            {"median_before_mm", r.before * 1e3},
            {"median_mm", r.median * 1e3},
            {"p90_mm", r.p90 * 1e3},
            {"covered", r.covered}};
}

Json region_json(const analysis::RegisteredRegion& region) {
    Json json = json_of(region.registration, region.registration.pose);
    json["points"] = region.points;
    json["area_mm2"] = region.area * 1e6;
    json["away"] = motion_json<Json>(region.away);
    json["point_to_point"] = {{"away", motion_json<Json>(region.plain_away)},
                              {"median_to_points_mm", region.plain_to_points * 1e3},
                              {"median_mm", region.plain_median * 1e3}};
    return json;
}

std::string_view verdict_text(fit::RegistrationVerdict verdict) {
    switch (verdict) {
        case fit::RegistrationVerdict::fit: return "fit";
        case fit::RegistrationVerdict::ambiguous: return "ambiguous";
        case fit::RegistrationVerdict::none: break;
    }
    return "none";
}

/// Degrees between two poses.
double angle_between(const Pose& a, const Pose& b) { return analysis::motion_between(a, b, Vec3(0.0)).angle_deg; }

Json json_of(const analysis::RegisteredSurface& found, bool region) {
    Json json = json_of(found.registration, found.pose);
    if (found.judged) {
        json["verdict"] = verdict_text(found.judged->verdict);
        json["rms_mm"] = found.judged->score * 1e3;
        json["rivals"] = Json::array();
        for (const fit::JudgedRegistration::Rival& rival : found.judged->rivals)
            json["rivals"].push_back({{"pose", pose_json<Json>(rival.pose)}, {"rms_mm", rival.score * 1e3}});
    }
    if (found.plane) {
        json["plane_normal"] = {found.plane->normal.x, found.plane->normal.y, found.plane->normal.z};
        json["plane_offset_mm"] = found.plane->offset * 1e3;
    } else if (region) {
        json["region"] = found.region ? region_json(*found.region) : Json(nullptr);
    }
    return json;
}

void print_region(const analysis::RegisteredRegion& region) {
    fmt::print(
        "a region of {:.0f} mm² lies {:.2f} mm and {:.2f}° from where it fits by itself, median distance there {:.2f} "
        "mm\n(plain ICP of points: {:.2f} mm and {:.2f}°, median distance there {:.2f} mm)\n",
        region.area * 1e6, 1e3 * region.away.distance, region.away.angle_deg, region.registration.median * 1e3,
        1e3 * region.plain_away.distance, region.plain_away.angle_deg, region.plain_median * 1e3);
}

void print_verdict(const fit::JudgedRegistration& judged) {
    switch (judged.verdict) {
        case fit::RegistrationVerdict::fit:
            fmt::print("verdict: fit; rms {:.2f} mm, ", judged.score * 1e3);
            if (judged.rivals.empty()) fmt::print("no other pose was found\n");
            else fmt::print("the next best pose {:.2f} mm\n", judged.rivals.front().score * 1e3);
            return;
        case fit::RegistrationVerdict::ambiguous:
            fmt::print("verdict: ambiguous; rms {:.2f} mm. Other poses fit about as well:\n", judged.score * 1e3);
            for (const fit::JudgedRegistration::Rival& rival : judged.rivals)
                fmt::print("  rotated by {:.1f}° against it, rms {:.2f} mm\n",
                           angle_between(judged.best.pose, rival.pose), rival.score * 1e3);
            return;
        case fit::RegistrationVerdict::none:
            fmt::print("verdict: none; no pose brings the surfaces together (rms {:.2f} mm at the best)\n",
                       judged.score * 1e3);
    }
}

int register_surfaces(const RegisterChoice& choice) {
    analysis::RegisterSettings settings = choice.settings;
    settings.away = choice.away * 1e-3;
    settings.gap = choice.gap * 1e-3;
    settings.margin = choice.margin * 1e-3;
    const analysis::RegisteredSurface found = analysis::register_files(settings);
    const bool is_fit = !found.judged || found.judged->verdict == fit::RegistrationVerdict::fit;
    if (choice.json) {
        fmt::print("{}\n", json_of(found, settings.region).dump(2));
        return is_fit ? done : answer_is_no;
    }
    const fit::Registration& r = found.registration;
    fmt::print("median distance {:.2f} mm (before {:.2f} mm), 90 % within {:.2f} mm\n", r.median * 1e3, r.before * 1e3,
               r.p90 * 1e3);
    if (found.judged) print_verdict(*found.judged);
    if (found.region) print_region(*found.region);
    else if (settings.region) fmt::print("no part is displaced\n");
    return is_fit ? done : answer_is_no;
}

Action declare_register(VerbOptions& verb) {
    const auto choice = std::make_shared<RegisterChoice>();
    analysis::RegisterSettings& settings = choice->settings;
    verb.add("moving", settings.moving, "bone file or mesh, which need not be closed").required();
    verb.add("fixed", settings.fixed, "bone file or mesh to register to").required();
    verb.flag("--mirror", settings.mirror, "the moving surface is from the other side of the body");
    verb.flag("--anywhere", settings.anywhere,
              "the position in the files means nothing (default: of poses that fit equally well, the nearest to it is "
              "taken)");
    verb.flag("--region", settings.region,
              "also find a part that is displaced against the rest, and register it separately");
    verb.add("--away", choice->away, "distance above which a point counts as displaced, mm")
        .unit("mm")
        .shows_default()
        .range(0.01, 100.0);
    verb.add("--gap", choice->gap, "greatest gap between points of a region, mm")
        .unit("mm")
        .shows_default()
        .range(0.1, 100.0);
    verb.add("--margin", choice->margin, "margin added to a region, mm").unit("mm").shows_default().range(0.0, 100.0);
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return register_surfaces(*choice); };
}

}  // namespace

Verb register_verb() { return {"register", "register a surface to another one of the same shape", declare_register}; }

}  // namespace tactus::command
