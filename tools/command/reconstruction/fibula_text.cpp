// SPDX-License-Identifier: Apache-2.0
#include "tools/command/reconstruction/fibula_text.hpp"

#include "dsp/core/constants.hpp"
#include "tools/command/plan/flap_text.hpp"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

namespace tactus::command {

namespace {

using file::Json;
using reconstruction::FibulaSegment;

double degrees(double radians) { return radians / degree; }

Json point_in_mm(const Vec3& p) { return Json::array({p.x / mm, p.y / mm, p.z / mm}); }

Json in_mm2(const std::optional<double>& area) { return area ? Json(*area * 1e6) : Json(nullptr); }

/// Row by row; lengths in mm.
Json matrix_of(const Pose& pose) {
    const Mat3 turn = glm::mat3_cast(pose.orientation);
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row)
        rows.push_back(Json::array({turn[0][row], turn[1][row], turn[2][row], pose.position[row] * 1e3}));
    rows.push_back(Json::array({0.0, 0.0, 0.0, 1.0}));
    return rows;
}

}  // namespace

file::Json fibula_json(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan) {
    Json segments = Json::array(), clearances = Json::array(), warnings = Json::array();
    for (const FibulaSegment& s : plan.segments) {
        Json one = Json::object();
        one["length_centre_mm"] = s.length_centre * 1e3;
        one["length_shortest_mm"] = in_mm(s.length_shortest);
        one["length_longest_mm"] = in_mm(s.length_longest);
        one["tilt_deg"] = Json::array({degrees(s.tilt[0]), degrees(s.tilt[1])});
        one["lean_medial_deg"] = Json::array({degrees(s.lean_medial[0]), degrees(s.lean_medial[1])});
        one["lean_anterior_deg"] = Json::array({degrees(s.lean_anterior[0]), degrees(s.lean_anterior[1])});
        one["area_mm2"] = Json::array({in_mm2(s.area[0]), in_mm2(s.area[1])});
        one["end_angle_deg"] = degrees(s.end_angle);
        one["donor_to_target"] = matrix_of(s.donor_to_target);
        Json cuts = Json::array();
        for (const reconstruction::Plane& cut : s.donor_plane)
            cuts.push_back({{"origin_mm", point_in_mm(cut.origin)},
                            {"normal", Json::array({cut.normal.x, cut.normal.y, cut.normal.z})}});
        one["donor_planes"] = cuts;
        one["along_line_mm"] = Json::array({s.along_line[0] * 1e3, s.along_line[1] * 1e3});
        segments.push_back(one);
    }
    const auto in_degrees = [](const std::vector<double>& angles) {
        Json list = Json::array();
        for (const double angle : angles) list.push_back(degrees(angle));
        return list;
    };
    for (const auto& clearance : plan.clearances) clearances.push_back(in_mm(clearance));
    for (const reconstruction::FibulaWarning& w : plan.warnings)
        warnings.push_back({{"code", reconstruction::name_of(w.code)},
                            {"text", w.text},
                            {"segment", w.segment < 0 ? Json(nullptr) : Json(w.segment)}});
    Json json = Json::object();
    json["segments"] = segments;
    json["wedges_deg"] = in_degrees(plan.wedges);
    json["off_bisector_deg"] = in_degrees(plan.off_bisector);
    json["rolls_deg"] = in_degrees(plan.rolls);
    json["clearances_mm"] = clearances;
    Json contact = Json::array();
    for (const auto& area : plan.contact) contact.push_back(in_mm2(area));
    json["contact_mm2"] = contact;
    json["kerf_loss_mm3"] = plan.kerf_loss ? Json(*plan.kerf_loss * 1e9) : Json(nullptr);
    if (inputs.from_curve) {
        Json joints = Json::array();
        for (const Vec3& p : inputs.from_curve->joints) joints.push_back(point_in_mm(p));
        json["joints_mm"] = joints;
        json["contour_deviation_mm"] =
            Json{{"rms", inputs.from_curve->rms * 1e3}, {"greatest", inputs.from_curve->greatest * 1e3}};
    }
    json["left_distal_mm"] = in_mm(plan.left_distal);
    json["left_proximal_mm"] = in_mm(plan.left_proximal);
    json["warnings"] = warnings;
    return json;
}

void print_fibula(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan) {
    if (inputs.from_curve)
        fmt::print("the jaw's curve lies {:.2f} mm rms from its segments, {:.2f} mm at most\n",
                   inputs.from_curve->rms * 1e3, inputs.from_curve->greatest * 1e3);
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        const FibulaSegment& s = plan.segments[n];
        fmt::print("segment {}: {:.2f} mm", n + 1, s.length_centre * 1e3);
        if (s.length_shortest)
            fmt::print(" ({:.2f} to {:.2f} mm on the surface)", *s.length_shortest * 1e3, *s.length_longest * 1e3);
        fmt::print(", cuts tilted by {:.2f}° and {:.2f}°, {:.2f}° between them; {:.2f} to {:.2f} mm along the line\n",
                   degrees(s.tilt[0]), degrees(s.tilt[1]), degrees(s.end_angle), s.along_line[0] * 1e3,
                   s.along_line[1] * 1e3);
        if (n < plan.wedges.size()) {
            fmt::print("  then a wedge of {:.2f}°", degrees(plan.wedges[n]));
            if (plan.clearances[n]) fmt::print(", {:.2f} mm of bone between the cuts", *plan.clearances[n] * 1e3);
            if (plan.contact[n]) fmt::print("; {:.0f} mm² of the cuts meet", *plan.contact[n] * 1e6);
            fmt::print("\n");
        }
    }
    if (plan.kerf_loss) fmt::print("a kerf of {:.1f} mm takes {:.0f} mm³\n", inputs.kerf * 1e3, *plan.kerf_loss * 1e9);
    for (const reconstruction::FibulaWarning& w : plan.warnings) fmt::print("warning: {}\n", w.text);
    fmt::print("for research, not a medical device\n");
}

}  // namespace tactus::command
