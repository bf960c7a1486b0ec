// SPDX-License-Identifier: Apache-2.0
#include "assets/markup/markup.hpp"

#include "assets/file/extension.hpp"
#include "assets/file/json_vector.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <charconv>
#include <cmath>

namespace tactus::markup {

namespace {

using file::Json;

constexpr double farthest_mm = 1e5;

const char* name_of(Kind kind) {
    constexpr std::array<const char*, 5> names{"Fiducial", "Line", "Angle", "Curve", "Plane"};
    return names[static_cast<std::size_t>(kind)];
}

Json in_mm(const Vec3& p) { return {p.x / mm, p.y / mm, p.z / mm}; }

/// Row by row.
Json rows_of(const Mat3& m) {
    Json list = Json::array();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) list.push_back(m[column][row]);
    return list;
}

Json rows_of(const Mat3& m, const Vec3& shift) {
    Json list = Json::array();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) list.push_back(m[column][row]);
        list.push_back(shift[row]);
    }
    for (const double last : {0.0, 0.0, 0.0, 1.0}) list.push_back(last);
    return list;
}

/// Right-handed axes whose third one is `normal`. The first one lies across the coordinate axis that is farthest from it.
Mat3 axes_with(const Vec3& normal) {
    const Vec3 size = glm::abs(normal);
    const Vec3 away = size.x <= size.y && size.x <= size.z ? Vec3(1.0, 0.0, 0.0)
                      : size.y <= size.z                   ? Vec3(0.0, 1.0, 0.0)
                                                           : Vec3(0.0, 0.0, 1.0);
    const Vec3 x = glm::normalize(glm::cross(away, normal));
    return {x, glm::cross(normal, x), normal};
}

Json json_of(const ControlPoint& point, std::size_t number, const Markup& markup, const Mat3& orientation) {
    return {{"id", fmt::format("{}", number)},
            {"label", point.label},
            {"description", point.description},
            {"associatedNodeID", ""},
            {"position", in_mm(point.position)},
            {"orientation", rows_of(orientation)},
            {"selected", true},
            {"locked", markup.is_locked},
            {"visibility", true},
            {"positionStatus", "defined"}};
}

void add_plane(Json& json, const Vec3& origin, const Mat3& axes, double side_mm) {
    json["planeType"] = "pointNormal";
    json["sizeMode"] = "absolute";
    json["autoScalingSizeFactor"] = 1.0;
    json["center"] = in_mm(origin);
    json["normal"] = file::json_of(axes[2]);
    json["objectToBase"] = rows_of(Mat3(-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0), Vec3(0.0));
    json["baseToNode"] = rows_of(axes, origin / mm);
    json["orientation"] = rows_of(axes);
    json["size"] = {side_mm, side_mm, 0.0};
    json["planeBounds"] = {-0.5 * side_mm, 0.5 * side_mm, -0.5 * side_mm, 0.5 * side_mm};
}

Json json_of(const Markup& markup) {
    const bool is_plane = markup.kind == Kind::plane;
    const Mat3 axes = is_plane ? axes_with(markup.normal) : Mat3(1.0);
    Json points = Json::array();
    for (const ControlPoint& point : markup.points)
        points.push_back(json_of(point, points.size() + 1, markup, is_plane ? axes : point.orientation));
    Json json{{"type", name_of(markup.kind)}};
    if (!markup.name.empty()) json["name"] = markup.name;
    json.update({{"coordinateSystem", "LPS"},
                 {"coordinateUnits", "mm"},
                 {"locked", markup.is_locked},
                 {"fixedNumberOfControlPoints", markup.has_fixed_count},
                 {"labelFormat", "%N-%d"},
                 {"lastUsedControlPointNumber", markup.points.size()}});
    if (is_plane) add_plane(json, markup.points.front().position, axes, markup.side / mm);
    json["controlPoints"] = points;
    if (markup.colour)
        json["display"] = {{"visibility", true},
                           {"color", file::json_of(*markup.colour)},
                           {"selectedColor", file::json_of(*markup.colour)},
                           {"propertiesLabelVisibility", false}};
    return json;
}

std::string text_in(const Json& json, std::string_view key) {
    const Json* found = json.find(key);
    return found && found->is_string() ? found->as_text() : "";
}

/// Left and posterior are positive in LPS.
double sign_of_frame(const std::string& frame) { return frame == "RAS" ? -1.0 : 1.0; }

std::string words_of(std::size_t number, const std::string& label) {
    return label.empty() ? fmt::format("control point {}", number)
                         : fmt::format("control point {} ('{}')", number, label);
}

/// The point, or none if its position is not set yet, which is noted.
std::optional<ControlPoint> point_of(const Json& json, std::size_t number, double sign, const std::string& file,
                                     std::vector<std::string>& notes) {
    ControlPoint point{text_in(json, "label"), Vec3(0.0), text_in(json, "description")};
    const std::string words = words_of(number, point.label);
    const Json* status = json.find("positionStatus");
    const std::string state = status ? text_in(json, "positionStatus") : "defined";
    if (state == "undefined" || state == "preview") {
        notes.push_back(fmt::format("{}: {} has no position (its status is \"{}\"): left out", file, words, state));
        return {};
    }
    if (state != "defined")
        throw Error(fmt::format("{}: {} has an unknown 'positionStatus': use \"defined\", \"undefined\" or \"preview\"",
                                file, words));
    const Json* position = json.find("position");
    const std::optional<Vec3> at = position ? file::vector_of(*position, farthest_mm) : std::nullopt;
    if (!at) throw Error(fmt::format("{}: {} has no position", file, words));
    point.position = {at->x * sign * mm, at->y * sign * mm, at->z * mm};
    return point;
}

/// Fields of a row; those in quotes may hold commas, and a doubled quote is one.
std::vector<std::string> fields_of(std::string_view row) {
    std::vector<std::string> fields(1);
    bool is_quoted = false;
    for (std::size_t n = 0; n < row.size(); ++n) {
        const char c = row[n];
        if (is_quoted && c == '"' && n + 1 < row.size() && row[n + 1] == '"') fields.back() += row[++n];
        else if (c == '"' && (is_quoted || fields.back().empty())) is_quoted = !is_quoted;
        else if (c == ',' && !is_quoted) fields.emplace_back();
        else if (c != '\r') fields.back() += c;
    }
    return fields;
}

/// The value of a comment such as "# CoordinateSystem = LPS".
std::optional<std::string> value_in(std::string_view line, std::string_view key) {
    const std::size_t at = line.find(key), equals = line.find('=', at == std::string_view::npos ? line.size() : at);
    if (equals == std::string_view::npos) return {};
    std::string value;
    for (const char c : line.substr(equals + 1))
        if (c != ' ' && c != '\r' && c != ',') value += c;
    return value;
}

}  // namespace

std::string text_of(std::span<const Markup> markups) {
    Json list = Json::array();
    for (const Markup& markup : markups) list.push_back(json_of(markup));
    const Json json{{"@schema",
                     "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
                     "markups-schema-v1.0.3.json#"},
                    {"markups", list}};
    return json.dump(2) + "\n";
}

ReadPoints points_of_text(std::string_view text, const std::string& file) {
    const Json json = file::parse_json(text, file);
    const Json* markups = json.find("markups");
    if (!markups || !markups->is_array())
        throw Error(fmt::format("{}: has no list 'markups': expected a file of markups of 3D Slicer", file));
    ReadPoints read;
    std::size_t number = 0;
    for (const Json& markup : *markups) {
        const Json* system = markup.find("coordinateSystem");
        const std::string frame = system && system->is_string() ? system->as_text() : "LPS";
        if (frame != "LPS" && frame != "RAS")
            throw Error(fmt::format("{}: 'coordinateSystem' must be \"LPS\" or \"RAS\", not \"{}\"", file, frame));
        // Slicer writes the unit alone, or as a code: ["mm", "UCUM", "millimeter"].
        if (const Json* unit = markup.find("coordinateUnits")) {
            const Json code = unit->is_array() && !unit->empty() ? *unit->begin() : *unit;
            if (!code.is_string() || (code.as_text() != "mm" && code.as_text() != "millimeter"))
                throw Error(fmt::format("{}: 'coordinateUnits' must be \"mm\"", file));
        }
        const Json* points = markup.find("controlPoints");
        if (!points || !points->is_array()) continue;
        const std::size_t first = read.points.size();
        for (const Json& point : *points)
            if (auto found = point_of(point, ++number, sign_of_frame(frame), file, read.notes))
                read.points.push_back(std::move(*found));
        if (read.points.size() > first) read.firsts.push_back(first);
    }
    return read;
}

std::vector<ControlPoint> points_of_markup(const ReadPoints& read, std::size_t index, const std::string& file) {
    if (index >= read.firsts.size())
        throw Error(fmt::format("{}: has no curve {}; {} of its markups have points, counted from 0", file, index,
                                read.firsts.size()));
    const auto at = [&](std::size_t n) {
        return read.points.begin() +
               static_cast<std::ptrdiff_t>(n < read.firsts.size() ? read.firsts[n] : read.points.size());
    };
    return {at(index), at(index + 1)};
}

ReadPoints points_of_fcsv(std::string_view text, const std::string& file) {
    constexpr std::size_t label_field = 11, description_field = 12;
    ReadPoints read;
    std::optional<std::string> frame;
    for (int number = 1; !text.empty(); ++number) {
        const std::size_t end = text.find('\n');
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (line.starts_with('#')) {
            if (const auto system = value_in(line, "CoordinateSystem")) frame = system;
            continue;
        }
        if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        if (frame == "0") frame = "RAS";
        if (frame == "1") frame = "LPS";
        if (frame != "RAS" && frame != "LPS")
            throw Error({file, number, 1}, "the line '# CoordinateSystem = LPS' (or RAS) is missing above the points");
        const std::vector<std::string> fields = fields_of(line);
        ControlPoint point;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string cell =
                static_cast<std::size_t>(axis) + 1 < fields.size() ? fields[static_cast<std::size_t>(axis) + 1] : "";
            double value = 0.0;
            const auto [rest, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
            if (error != std::errc{} || rest != cell.data() + cell.size() || !(std::abs(value) <= farthest_mm))
                throw Error({file, number, 1}, fmt::format("'{}' is not a coordinate in mm", cell));
            point.position[axis] = value * mm * (axis < 2 ? sign_of_frame(*frame) : 1.0);
        }
        if (fields.size() > label_field) point.label = fields[label_field];
        if (fields.size() > description_field) point.description = fields[description_field];
        read.points.push_back(std::move(point));
    }
    if (!read.points.empty()) read.firsts = {0};
    return read;
}

ReadPoints read_points(const std::filesystem::path& path) {
    const std::string text = file::read_whole_file(path);
    return file::extension_of(path) == ".fcsv" ? points_of_fcsv(text, path.string())
                                               : points_of_text(text, path.string());
}

}  // namespace tactus::markup
