// SPDX-License-Identifier: Apache-2.0
// Reads markups by the rules of 3D Slicer's own reader, and refuses what that refuses. The rules are those of
// Modules/Loadable/Markups/MRML/vtkMRMLMarkupsJsonStorageNode.cxx, vtkMRMLMarkupsPlaneJsonStorageNode.cxx,
// vtkMRMLMarkupsPlaneNode.cxx and Resources/Schema/markups-schema-v1.0.3.json of Slicer 5. Shares no code with
// assets/markup: everything is converted to RAS, as Slicer does.
#pragma once

#include "assets/file/json.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::test {

struct SlicerMarkup {
    std::string type, name;
    std::vector<Vec3> points;  ///< mm, RAS
    std::vector<std::string> labels;
    // Of a plane, mm, RAS:
    Vec3 origin{0.0}, normal{0.0};
    double determinant = 0.0;  ///< of its axes
    std::array<double, 3> size{};
};

namespace slicer_rules {

[[noreturn]] inline void refuse(const std::string& why) { throw std::runtime_error("Slicer refuses: " + why); }

inline std::vector<double> numbers(const file::Json& json, std::size_t count, const char* what) {
    if (!json.is_array() || json.size() != count) refuse(std::string(what) + ": wrong number of elements");
    std::vector<double> list;
    for (const file::Json& element : json) {
        if (!element.is_number()) refuse(std::string(what) + ": no number");
        list.push_back(element.get<double>());
    }
    return list;
}

/// Row by row; LPS to RAS negates the first two rows.
inline std::array<std::array<double, 4>, 4> matrix(const file::Json& json, bool is_lps, const char* what) {
    const std::vector<double> list = numbers(json, 16, what);
    std::array<std::array<double, 4>, 4> m{};
    for (std::size_t n = 0; n < 16; ++n) m[n / 4][n % 4] = is_lps && n < 8 ? -list[n] : list[n];
    return m;
}

inline void read_plane(const file::Json& json, bool is_lps, SlicerMarkup& to) {
    static const std::array<std::string, 3> types{"threePoints", "pointNormal", "planeFit"};
    if (!json.contains("planeType")) refuse("a plane without planeType is one of three points");
    if (std::ranges::find(types, json["planeType"].as_text()) == types.end()) refuse("unknown planeType");
    if (json["planeType"].as_text() != "pointNormal" || to.points.size() != 1)
        refuse("a plane of a point and a normal has one control point");
    std::array<std::array<double, 4>, 4> object{}, base{};
    for (std::size_t n = 0; n < 4; ++n) object[n][n] = base[n][n] = 1.0;
    if (json.contains("objectToBase")) object = matrix(json["objectToBase"], is_lps, "objectToBase");
    if (json.contains("baseToNode")) base = matrix(json["baseToNode"], is_lps, "baseToNode");
    Mat3 axes(0.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            for (std::size_t k = 0; k < 3; ++k)
                axes[column][row] +=
                    base[static_cast<std::size_t>(row)][k] * object[k][static_cast<std::size_t>(column)];
    to.origin = to.points.front();
    to.normal = axes[2];
    to.determinant = glm::dot(glm::cross(axes[0], axes[1]), axes[2]);
    if (json.contains("sizeMode") && json["sizeMode"].as_text() != "auto" && json["sizeMode"].as_text() != "absolute")
        refuse("unknown sizeMode");
    if (json.contains("size")) std::ranges::copy(numbers(json["size"], 3, "size"), to.size.begin());
    if (json.contains("planeBounds")) numbers(json["planeBounds"], 4, "planeBounds");
}

inline void read_point(const file::Json& json, bool is_lps, SlicerMarkup& to) {
    if (json.contains("positionStatus")) {
        static const std::array<std::string, 3> known{"undefined", "preview", "defined"};
        if (std::ranges::find(known, json["positionStatus"].as_text()) == known.end()) refuse("unknown positionStatus");
    }
    const std::vector<double> at = numbers(json["position"], 3, "position");
    if (json.contains("orientation")) numbers(json["orientation"], 9, "orientation");
    for (const char* key : {"id", "label", "description", "associatedNodeID"})
        if (json.contains(key) && !json[key].is_string()) refuse(std::string(key) + " is no text");
    for (const char* key : {"selected", "locked", "visibility"})
        if (json.contains(key) && !json[key].is_boolean()) refuse(std::string(key) + " is no truth value");
    const double sign = is_lps ? -1.0 : 1.0;
    to.points.emplace_back(sign * at[0], sign * at[1], at[2]);
    to.labels.push_back(json.value("label", std::string()));
}

}  // namespace slicer_rules

/// Throws std::runtime_error for a file that Slicer does not open.
inline std::vector<SlicerMarkup> read_as_slicer(std::string_view text) {
    using namespace slicer_rules;
    const file::Json root = file::Json::parse(text);
    if (!root.contains("@schema")) refuse("no @schema");
    std::string schema = root["@schema"].as_text();
    std::ranges::transform(schema, schema.begin(), [](unsigned char c) { return std::tolower(c); });
    if (!std::regex_match(schema, std::regex(".*markups-schema-v1\\.[0-9]+\\.[0-9]+\\.json#*")))
        refuse("another @schema");
    if (!root.contains("markups") || !root["markups"].is_array() || root["markups"].empty())
        refuse("no list of markups");
    std::vector<SlicerMarkup> all;
    for (const file::Json& json : root["markups"]) {
        static const std::array<std::string, 7> classes{"Fiducial",    "Line",  "Angle", "Curve",
                                                        "ClosedCurve", "Plane", "ROI"};
        SlicerMarkup one;
        one.type = json["type"].as_text();
        if (std::ranges::find(classes, one.type) == classes.end()) refuse("unknown type " + one.type);
        one.name = json.value("name", std::string());
        const std::string frame = json.value("coordinateSystem", std::string("LPS"));
        if (frame != "LPS" && frame != "RAS") refuse("unknown coordinateSystem");
        if (json.value("coordinateUnits", std::string("mm")) != "mm") refuse("other units than the scene");
        for (const char* key : {"locked", "fixedNumberOfControlPoints"})
            if (json.contains(key) && !json[key].is_boolean()) refuse(std::string(key) + " is no truth value");
        for (const file::Json& point : json["controlPoints"]) read_point(point, frame == "LPS", one);
        if (one.type == "Line" && one.points.size() > 2) refuse("a line has two points");
        if (one.type == "Angle" && one.points.size() > 3) refuse("an angle has three points");
        if (one.type == "Plane") read_plane(json, frame == "LPS", one);
        if (const file::Json* display = json.find("display"))
            for (const char* key : {"color", "selectedColor"})
                if (display->contains(key))
                    for (const double part : numbers((*display)[key], 3, key))
                        if (!(part >= 0.0 && part <= 1.0)) refuse("a colour beyond 0 to 1");
        all.push_back(one);
    }
    return all;
}

}  // namespace tactus::test
