// SPDX-License-Identifier: Apache-2.0
#include "assets/reconstruction/fibula_inputs.hpp"

#include "assets/file/json.hpp"
#include "assets/file/json_frame.hpp"
#include "assets/file/json_vector.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

namespace tactus::reconstruction {

namespace {

using file::Json;

/// Of the whole file; "source" and "notes" are for people, those from "vessels" on are of the flap.
const std::vector<std::string> member_names{"units",
                                            "frame",
                                            "source",
                                            "notes",
                                            "mandible_planes",
                                            "jaw_curve",
                                            "segments",
                                            "least_segment_mm",
                                            "fibula_line",
                                            "leg",
                                            "between_space_mm",
                                            "additional_between_space_mm_default",
                                            "distal_margin_mm",
                                            "proximal_margin_mm",
                                            "along_line_mm",
                                            "roll_deg",
                                            "reversed",
                                            "kerf_mm",
                                            "resection",
                                            "donor",
                                            "jaw",
                                            "tumour",
                                            "vessels",
                                            "perforators",
                                            "sites",
                                            "plates",
                                            "implants",
                                            "paddle",
                                            "margin_mm",
                                            "limits"},
    line_names{"point", "direction"};

Vec3 vector_of(const Json& json, const char* key, const std::string& where) {
    const Json* found = json.find(key);
    const std::optional<Vec3> v = found ? file::vector_of(*found, farthest_mm) : std::nullopt;
    if (!v)
        throw Error(
            fmt::format("{}: '{}' must be a list of three numbers, each at most {:.0f}", where, key, farthest_mm));
    return *v;
}

double length_of(const Json& json, const char* key, double otherwise, double max_mm, const std::string& file) {
    const Json* found = json.find(key);
    if (!found) return otherwise;
    const double value = found->is_number() ? found->get<double>() : -1.0;
    if (!(value >= 0.0 && value <= max_mm))
        throw Error(fmt::format("{}: '{}' must be a number from 0 to {:.0f}", file, key, max_mm));
    return value * mm;
}

std::vector<JawPlane> planes_of(const Json& planes, const std::string& file) {
    if (planes.size() < 2 || planes.size() > max_planes)
        throw Error(fmt::format("{}: {} mandible planes; a plan needs 2 to {}", file, planes.size(), max_planes));
    std::vector<JawPlane> found;
    const std::vector<std::string> names{"name", "origin", "normal", "x", "y"};
    for (const Json& one : planes) {
        const std::string where = fmt::format("{}: plane {}", file, found.size() + 1);
        if (!one.is_object()) throw Error(fmt::format("{} is no object", where));
        file::refuse_unknown(one, where, names);
        JawPlane plane{vector_of(one, "origin", where) * mm, {}, {}};
        if (one.contains("normal")) plane.normal = vector_of(one, "normal", where);
        if (one.contains("y")) plane.y = vector_of(one, "y", where);
        found.push_back(plane);
    }
    return found;
}

CurveSplit curve_of(const Json& json, const std::string& file) {
    std::vector<Vec3> curve;
    for (const Json& point : json["jaw_curve"]) {
        const std::optional<Vec3> v = file::vector_of(point, farthest_mm);
        if (!v) throw Error(fmt::format("{}: point {} of 'jaw_curve' is no list of three numbers", file, curve.size()));
        curve.push_back(*v * mm);
    }
    const Json* count = json.find("segments");
    const double segments = count && count->is_number() ? count->get<double>() : 0.0;
    if (!(segments >= 1.0 && segments <= 5.0 && segments == std::floor(segments)))
        throw Error(fmt::format("{}: 'jaw_curve' needs 'segments', a number from 1 to 5", file));
    const double least = length_of(json, "least_segment_mm", 20.0 * mm, 1000.0, file);
    try {
        return split_curve(curve, static_cast<std::size_t>(segments), least);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file, error.message()));
    }
}

}  // namespace

FibulaInputs fibula_inputs_of_text(std::string_view text, const std::string& file, std::string* donor,
                                   std::string* jaw) {
    const Json json = file::parse_json(text, file);
    file::refuse_unknown(json, file, member_names);
    const bool has_planes = json.is_object() && json.contains("mandible_planes") && json["mandible_planes"].is_array(),
               has_curve = json.is_object() && json.contains("jaw_curve") && json["jaw_curve"].is_array();
    if (has_planes == has_curve || !json.contains("fibula_line") || !json["fibula_line"].is_object())
        throw Error(fmt::format(
            "{}: expected an object with 'fibula_line' and either 'mandible_planes' or 'jaw_curve' (a list)", file));
    file::require_lps_mm(json, "units", file);
    FibulaInputs inputs;
    if (has_planes) inputs.planes = planes_of(json["mandible_planes"], file);
    else {
        inputs.from_curve = curve_of(json, file);
        inputs.planes = planes_on(*inputs.from_curve);
    }
    const std::string line = file + ": fibula_line";
    file::refuse_unknown(json["fibula_line"], line, line_names);
    inputs.line_point = vector_of(json["fibula_line"], "point", line) * mm;
    inputs.line_direction = vector_of(json["fibula_line"], "direction", line);
    if (const Json* leg = json.find("leg")) {
        const std::string text_of_leg = leg->is_string() ? leg->as_text() : "";
        if (text_of_leg != "left" && text_of_leg != "right")
            throw Error(fmt::format("{}: 'leg' must be \"left\" or \"right\"", file));
        inputs.leg = text_of_leg == "left" ? Leg::left : Leg::right;
    }
    // The name that the published inputs use, too.
    inputs.between = length_of(json, "additional_between_space_mm_default", inputs.between, 100.0, file);
    inputs.between = length_of(json, "between_space_mm", inputs.between, 100.0, file);
    inputs.distal_margin = length_of(json, "distal_margin_mm", inputs.distal_margin, 1000.0, file);
    inputs.proximal_margin = length_of(json, "proximal_margin_mm", inputs.proximal_margin, 1000.0, file);
    inputs.kerf = length_of(json, "kerf_mm", inputs.kerf, 9.0, file);
    if (const Json* along = json.find("along_line_mm")) {
        const bool is_list = along->is_array() && along->size() + 1 == inputs.planes.size() &&
                             std::all_of(along->begin(), along->end(), [](const Json& x) {
                                 return x.is_number() && std::abs(x.get<double>()) <= farthest_mm;
                             });
        if (!is_list)
            throw Error(fmt::format("{}: 'along_line_mm' must be a list of {} numbers, one per segment", file,
                                    inputs.planes.size() - 1));
        for (const Json& start : *along) inputs.along_line.push_back(start.get<double>() * mm);
    }
    if (const Json* roll = json.find("roll_deg")) {
        const double angle = roll->is_number() ? roll->get<double>() : 1e9;
        if (!(std::abs(angle) <= 360.0)) throw Error(fmt::format("{}: 'roll_deg' must be -360 to 360", file));
        inputs.roll = angle * std::numbers::pi / 180.0;
    }
    if (const Json* reversed = json.find("reversed")) {
        if (!reversed->is_boolean()) throw Error(fmt::format("{}: 'reversed' must be true or false", file));
        inputs.reversed = reversed->get<bool>();
    }
    if (const Json* taken = json.find("resection")) {
        using enum Resection;
        const std::string word = taken->is_string() ? taken->as_text() : "";
        const Resection all[] = {between, after_first, before_last, none};
        const auto meant = std::ranges::find_if(all, [&](Resection r) { return word == name_of(r); });
        if (meant == std::end(all))
            throw Error(
                fmt::format("{}: 'resection' must be \"between\", \"after-first\", \"before-last\" or \"none\"", file));
        inputs.resection = *meant;
    }
    for (const auto& [key, path] : {std::pair{"donor", donor}, std::pair{"jaw", jaw}}) {
        const Json* mesh = json.find(key);
        if (!mesh) continue;
        if (!mesh->is_string() || mesh->as_text().empty())
            throw Error(fmt::format("{}: '{}' must be the path of a mesh", file, key));
        if (path) *path = mesh->as_text();
    }
    return inputs;
}

FibulaInputs read_fibula_inputs(const std::filesystem::path& path) {
    std::string donor, jaw;
    FibulaInputs inputs = fibula_inputs_of_text(file::read_whole_file(path), path.string(), &donor, &jaw);
    if (!donor.empty()) inputs.donor = read_surface(path.parent_path() / donor);
    if (!jaw.empty()) inputs.jaw = read_surface(path.parent_path() / jaw);
    return inputs;
}

}  // namespace tactus::reconstruction
