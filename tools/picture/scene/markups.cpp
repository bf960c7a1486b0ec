// SPDX-License-Identifier: Apache-2.0
#include "tools/picture/scene/markups.hpp"

#include "assets/file/json.hpp"
#include "dsp/display/ruler.hpp"

#include <fmt/format.h>

#include <numbers>

namespace tactus::picture {

using file::Json;

std::string measurement_words(const Measurement& measured) {
    const std::span points(measured.points);
    if (points.size() < 2) return {};
    std::string text = fmt::format("{:.2f} mm", 1e3 * display::path_length(points.first(2)));
    if (points.size() < 3) return text;
    text += fmt::format(", {:.2f} mm", 1e3 * display::path_length(points.subspan(1, 2)));
    if (const auto angle = display::angle_at(points[1], points[0], points[2]))
        text += fmt::format(", {:.1f}°", *angle * 180.0 / std::numbers::pi);
    return text;
}

std::string markups_text(std::span<const Measurement> all) {
    Json markups = Json::array();
    for (const Measurement& one : all) {
        if (one.points.size() != 2 && one.points.size() != 3) continue;
        Json points = Json::array();
        for (std::size_t n = 0; n < one.points.size(); ++n) {
            const Vec3 p = one.points[n] * 1e3;
            points.push_back({{"id", fmt::format("{}", n + 1)},
                              {"label", fmt::format("{}-{}", one.name, n + 1)},
                              {"description", measurement_words(one)},
                              {"associatedNodeID", ""},
                              {"position", {p.x, p.y, p.z}},
                              {"orientation", {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}},
                              {"selected", true},
                              {"locked", false},
                              {"visibility", true},
                              {"positionStatus", "defined"}});
        }
        markups.push_back({{"type", one.points.size() == 2 ? "Line" : "Angle"},
                           {"coordinateSystem", "LPS"},
                           {"coordinateUnits", "mm"},
                           {"locked", false},
                           {"fixedNumberOfControlPoints", true},
                           {"labelFormat", "%N-%d"},
                           {"lastUsedControlPointNumber", one.points.size()},
                           {"controlPoints", points}});
    }
    const Json json{{"@schema",
                     "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
                     "markups-schema-v1.0.3.json#"},
                    {"markups", markups}};
    return json.dump(2) + "\n";
}

}  // namespace tactus::picture
