// SPDX-License-Identifier: Apache-2.0
// tactus register: registers a surface to another one of the same shape, as a whole or by parts.
#include "assets/file/json.hpp"
#include "tools/command/options.hpp"
#include "tools/command/pose_text.hpp"
#include "tools/exit_code.hpp"
#include "tools/study/bones/registration.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

using file::Json;

struct RegisterChoice {
    study::RegisterSettings settings;
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

Json region_json(const study::RegisteredRegion& region) {
    Json json = json_of(region.registration, region.registration.pose);
    json["points"] = region.points;
    json["area_mm2"] = region.area * 1e6;
    json["away"] = motion_json<Json>(region.away);
    json["point_to_point"] = {{"away", motion_json<Json>(region.plain_away)},
                              {"median_to_points_mm", region.plain_to_points * 1e3},
                              {"median_mm", region.plain_median * 1e3}};
    return json;
}

Json json_of(const study::RegisteredSurface& found, bool region) {
    Json json = json_of(found.registration, found.pose);
    if (found.plane) {
        json["plane_normal"] = {found.plane->normal.x, found.plane->normal.y, found.plane->normal.z};
        json["plane_offset_mm"] = found.plane->offset * 1e3;
    } else if (region) {
        json["region"] = found.region ? region_json(*found.region) : Json(nullptr);
    }
    return json;
}

void print_region(const study::RegisteredRegion& region) {
    fmt::print(
        "a region of {:.0f} mm² lies {:.2f} mm and {:.2f}° from where it fits by itself, median distance there {:.2f} "
        "mm\n(plain ICP of points: {:.2f} mm and {:.2f}°, median distance there {:.2f} mm)\n",
        region.area * 1e6, 1e3 * region.away.distance, region.away.angle_deg, region.registration.median * 1e3,
        1e3 * region.plain_away.distance, region.plain_away.angle_deg, region.plain_median * 1e3);
}

int register_surfaces(const RegisterChoice& choice) {
    study::RegisterSettings settings = choice.settings;
    settings.away = choice.away * 1e-3;
    settings.gap = choice.gap * 1e-3;
    settings.margin = choice.margin * 1e-3;
    const study::RegisteredSurface found = study::register_files(settings);
    if (choice.json) {
        fmt::print("{}\n", json_of(found, settings.region).dump(2));
        return done;
    }
    const fit::Registration& r = found.registration;
    fmt::print("median distance {:.2f} mm (before {:.2f} mm), 90 % within {:.2f} mm\n", r.median * 1e3, r.before * 1e3,
               r.p90 * 1e3);
    if (found.region) print_region(*found.region);
    else if (settings.region) fmt::print("no part is displaced\n");
    return done;
}

Action declare_register(VerbOptions& verb) {
    const auto choice = std::make_shared<RegisterChoice>();
    study::RegisterSettings& settings = choice->settings;
    verb.add("moving", settings.moving, "bone file or mesh, which need not be closed").required();
    verb.add("fixed", settings.fixed, "bone file or mesh to register to").required();
    verb.flag("--mirror", settings.mirror, "the moving surface is from the other side of the body");
    verb.flag("--anywhere", settings.anywhere, "start from any position (default: from the position in the files)");
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
