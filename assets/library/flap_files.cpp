// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/library/flap_case.hpp"
#include "assets/markup/markup.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/vessel/track_file.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <cmath>
#include <numbers>

namespace tactus::library {

namespace {

using file::Json;

double rounded(double value) { return std::round(value * 1e6) / 1e6; }
Json in_mm(const Vec3& p) { return Json::array({rounded(p.x * 1e3), rounded(p.y * 1e3), rounded(p.z * 1e3)}); }
Json as_is(const Vec3& v) { return Json::array({rounded(v.x), rounded(v.y), rounded(v.z)}); }

/// Points for 3D Slicer.
std::string markups(const std::vector<NamedPoint>& points) {
    markup::Markup list;
    for (const NamedPoint& point : points)
        list.points.push_back({point.name, glm::round(point.position * 1e9) * 1e-9, "synthetic"});
    return markup::text_of({&list, 1});
}

std::string inputs_text(const FlapCase& made) {
    Json planes = Json::array(), notes = Json::array();
    for (const reconstruction::JawPlane& plane : made.inputs.planes) {
        Json one{{"name", fmt::format("plane {}", planes.size() + 1)}, {"origin", in_mm(plane.origin)}};
        if (plane.normal) one["normal"] = as_is(*plane.normal);
        planes.push_back(one);
    }
    for (const std::string& note : made.notes) notes.push_back(note);
    const Json json{
        {"units", "mm"},
        {"frame", "LPS; jaw and sites in one, fibula, vessels and perforators in another"},
        {"notes", notes},
        {"jaw", "jaw.stl"},
        {"donor", "fibula.stl"},
        {"leg", made.inputs.leg == reconstruction::Leg::left ? "left" : "right"},
        {"mandible_planes", planes},
        {"fibula_line", {{"point", in_mm(made.inputs.line_point)}, {"direction", as_is(made.inputs.line_direction)}}},
        {"roll_deg", rounded(made.inputs.roll * 180.0 / std::numbers::pi)},
        {"vessels",
         Json::array({Json{{"kind", "artery"}, {"file", "artery.csv"}}, Json{{"kind", "vein"}, {"file", "vein.csv"}}})},
        {"perforators", "perforators.mrk.json"},
        {"sites", "sites.mrk.json"},
        {"tumour", "tumour.stl"},
        {"margin_mm", 10}};
    return json.dump(2) + "\n";
}

}  // namespace

void write_flap(const FlapCase& made, const std::filesystem::path& folder) {
    const auto mesh = [&](const geometry::TriangleSurface& surface, const char* name) {
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{surface, {}}}, folder / name);
    };
    mesh(made.jaw, "jaw.stl");
    mesh(made.fibula, "fibula.stl");
    mesh(made.tumour, "tumour.stl");
    vessel::write_track(made.artery, folder / "artery.csv");
    vessel::write_track(made.artery, folder / "artery.mrk.json");
    vessel::write_track(made.vein, folder / "vein.csv");
    file::write_whole_file(folder / "perforators.mrk.json", markups(made.perforators));
    file::write_whole_file(folder / "sites.mrk.json", markups(made.sites));
    file::write_whole_file(folder / "INPUTS.json", inputs_text(made));
}

}  // namespace tactus::library
