// SPDX-License-Identifier: Apache-2.0
#include "assets/reconstruction/reconstruction.hpp"

#include "assets/file/json_vector.hpp"
#include "assets/reconstruction/fibula_inputs.hpp"
#include "assets/reconstruction/flap_json.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace tactus::reconstruction {

using file::Json;

namespace {

using file::json_of;

constexpr Resection resections[] = {Resection::between, Resection::after_first, Resection::before_last,
                                    Resection::none};

Json json_of(const MeshFile& mesh) { return {{"file", mesh.file}, {"hash", fmt::format("{:016x}", mesh.hash)}}; }

MeshFile mesh_of(const Members& item) {
    const std::string digits = item.text("hash");
    if (digits.size() != 16 || digits.find_first_not_of("0123456789abcdef") != std::string::npos)
        item.fail("has a 'hash' that is not a hash");
    MeshFile mesh{item.text("file"), std::stoull(digits, nullptr, 16)};
    if (mesh.file.empty()) item.fail("has an empty 'file'");
    return mesh;
}

Json json_of(const KeptGuide& guide) {
    Json json{{"name", guide.name},     {"bone", guide.is_of_jaw ? "jaw" : "fibula"},
              {"cut", guide.cut},       {"sides", guide.sides},
              {"turn_rad", guide.turn}, {"mesh", json_of(guide.mesh)}};
    if (!guide.label.empty()) json["label"] = guide.label;
    return json;
}

/// A whole number of a range.
int whole_of(const Members& item, const char* key, int low, int high) {
    const double value = item.number(key);
    if (!(value >= low && value <= high) || value != std::floor(value))
        item.fail(fmt::format("has a '{}' that is not a whole number from {} to {}", key, low, high));
    return static_cast<int>(value);
}

KeptGuide guide_of(const Members& item) {
    KeptGuide guide;
    guide.name = item.name();
    const std::string bone = item.text("bone");
    if (bone != "jaw" && bone != "fibula") item.fail("must have the 'bone' \"jaw\" or \"fibula\"");
    guide.is_of_jaw = bone == "jaw";
    guide.cut = whole_of(item, "cut", 0, 2);
    guide.sides = whole_of(item, "sides", 1, 3);
    guide.turn = item.number("turn_rad");
    if (!(std::abs(guide.turn) <= 2.0 * std::numbers::pi + 1e-9)) item.fail("has a 'turn_rad' of more than a turn");
    if (item.has("label")) guide.label = item.text("label");
    const auto mesh = item.object("mesh");
    if (!mesh) item.fail("has no 'mesh'");
    guide.mesh = mesh_of(*mesh);
    return guide;
}

Json json_of(const FibulaInputs& inputs) {
    Json planes = Json::array(), along = Json::array();
    for (const JawPlane& plane : inputs.planes) {
        Json one{{"origin_m", json_of(plane.origin)}};
        if (plane.normal) one["normal"] = json_of(*plane.normal);
        if (plane.y) one["y"] = json_of(*plane.y);
        planes.push_back(one);
    }
    for (const double place : inputs.along_line) along.push_back(place);
    Json json{{"planes", planes},
              {"line", {{"point_m", json_of(inputs.line_point)}, {"direction", json_of(inputs.line_direction)}}},
              {"leg", inputs.leg == Leg::left ? "left" : "right"},
              {"between_m", inputs.between},
              {"distal_margin_m", inputs.distal_margin},
              {"proximal_margin_m", inputs.proximal_margin},
              {"kerf_m", inputs.kerf},
              {"along_line_m", along},
              {"roll_rad", inputs.roll},
              {"reversed", inputs.reversed},
              {"resection", name_of(inputs.resection)}};
    if (inputs.from_curve) {
        Json joints = Json::array();
        for (const Vec3& joint : inputs.from_curve->joints) joints.push_back(json_of(joint));
        json["curve"] = {
            {"joints_m", joints}, {"rms_m", inputs.from_curve->rms}, {"greatest_m", inputs.from_curve->greatest}};
    }
    return json;
}

double not_negative(const Members& item, const char* key) {
    const double length = item.length(key);
    if (length < 0.0) item.fail(fmt::format("has a negative '{}'", key));
    return length;
}

FibulaInputs inputs_of(const Members& item) {
    FibulaInputs inputs;
    for (const Members& plane : item.list("planes", max_planes)) {
        inputs.planes.push_back({plane.place("origin"), {}, {}});
        if (plane.has("normal")) inputs.planes.back().normal = plane.direction("normal");
        if (plane.has("y")) inputs.planes.back().y = plane.direction("y");
    }
    if (inputs.planes.size() < 2) item.fail("has less than two planes");
    const auto line = item.object("line");
    if (!line) item.fail("has no 'line'");
    inputs.line_point = line->place("point");
    inputs.line_direction = line->direction("direction");
    const std::string leg = item.text("leg");
    if (leg != "left" && leg != "right") item.fail("must have the 'leg' \"left\" or \"right\"");
    inputs.leg = leg == "left" ? Leg::left : Leg::right;
    inputs.between = not_negative(item, "between");
    inputs.distal_margin = not_negative(item, "distal_margin");
    inputs.proximal_margin = not_negative(item, "proximal_margin");
    inputs.kerf = not_negative(item, "kerf");
    inputs.along_line = item.lengths("along_line", max_planes);
    if (!inputs.along_line.empty() && inputs.along_line.size() + 1 != inputs.planes.size())
        item.fail("needs one place 'along_line_m' per segment, or none");
    inputs.roll = item.number("roll_rad");
    if (!(std::abs(inputs.roll) <= 2.0 * std::numbers::pi + 1e-9)) item.fail("has a 'roll_rad' of more than a turn");
    inputs.reversed = item.truth("reversed");
    const std::string taken = item.text("resection");
    const auto meant = std::ranges::find_if(resections, [&](Resection r) { return taken == name_of(r); });
    if (meant == std::end(resections)) item.fail(fmt::format("has the unknown 'resection' '{}'", taken));
    inputs.resection = *meant;
    if (const auto curve = item.object("curve"))
        inputs.from_curve = CurveSplit{curve->places("joints", max_planes), not_negative(*curve, "rms"),
                                       not_negative(*curve, "greatest")};
    return inputs;
}

}  // namespace

Json json_of(const Reconstruction& all) {
    Json json = json_of(all.inputs);
    json["donor"] = json_of(all.donor);
    if (all.jaw) json["jaw"] = json_of(*all.jaw);
    if (all.tumour) json["tumour"] = json_of(*all.tumour);
    if (!all.guides.empty()) {
        Json guides = Json::array();
        for (const KeptGuide& guide : all.guides) guides.push_back(json_of(guide));
        json["guides"] = guides;
    }
    add_members(json, all.flap);
    return json;
}

Reconstruction reconstruction_of(const Json& json, const std::string& where) {
    const Members item(json, where, in_metres);
    Reconstruction all;
    all.inputs = inputs_of(item);
    const auto donor = item.object("donor"), jaw = item.object("jaw"), tumour = item.object("tumour");
    if (!donor) item.fail("has no 'donor'");
    all.donor = mesh_of(*donor);
    if (jaw) all.jaw = mesh_of(*jaw);
    if (tumour) all.tumour = mesh_of(*tumour);
    constexpr std::size_t max_guides = 100;
    for (const Members& guide : item.list("guides", max_guides)) {
        all.guides.push_back(guide_of(guide));
        const auto is_same = [&](const KeptGuide& other) { return other.name == all.guides.back().name; };
        if (std::ranges::count_if(all.guides, is_same) > 1) guide.fail("has a name that another guide has");
    }
    all.flap = flap_of(item);
    return all;
}

Flap flap_of_inputs(const Json& json, const std::string& where) {
    return flap_of(Members(json, where, in_millimetres));
}

void check(const Flap& flap, const std::string& where) {
    Json json = Json::object();
    add_members(json, flap);
    flap_of(Members(json, where, in_metres));
}

}  // namespace tactus::reconstruction
