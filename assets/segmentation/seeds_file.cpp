// SPDX-License-Identifier: Apache-2.0
#include "assets/segmentation/seeds_file.hpp"

#include "assets/file/json.hpp"
#include "assets/file/json_frame.hpp"
#include "assets/file/json_vector.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/table/log_lines.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>

namespace tactus::segmentation {

namespace {

using file::Json;

constexpr double farthest_mm = farthest_seed / mm, widest_mm = widest_brush / mm;
constexpr std::size_t max_points = 1'000'000;

constexpr const char* expected =
    R"({"labels": [{"name": "main", "colour": "#d95f02", "strokes": [{"radius_mm": 3, "points_mm": [[x, y, z], ...]}]}, ...]})";

const std::vector<std::string> file_names{"frame", "unit", "labels"}, label_names{"name", "colour", "strokes"},
    stroke_names{"radius_mm", "points_mm"};

double rounded_mm(double metres) { return std::round(metres * 1e6) / 1e3; }

Vec3 colour_of(const Json& json, const std::string& where) {
    const std::string text = json.is_string() ? json.get<std::string>() : "";
    unsigned r = 0, g = 0, b = 0;
    const bool is_hex =
        text.size() == 7 && text[0] == '#' &&
        std::all_of(text.begin() + 1, text.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
    if (!is_hex || std::sscanf(text.c_str(), "#%2x%2x%2x", &r, &g, &b) != 3)
        throw Error(fmt::format("{}: 'colour' must be a text such as \"#d95f02\"", where));
    return Vec3(r, g, b) / 255.0;
}

Vec3 point_of(const Json& json, const std::string& where) {
    const std::optional<Vec3> point = file::vector_of(json, farthest_mm);
    if (!point)
        throw Error(
            fmt::format("{}: a point is a list of three numbers in mm, each at most {:.0f}", where, farthest_mm));
    return *point * mm;
}

Stroke stroke_of(const Json& json, const std::string& where) {
    file::refuse_unknown(json, where, stroke_names);
    if (!json.is_object() || !json.contains("points_mm") || !json["points_mm"].is_array() || json["points_mm"].empty())
        throw Error(fmt::format("{}: 'points_mm' must be a list of at least one point", where));
    if (json["points_mm"].size() > max_points) throw Error(fmt::format("{}: more than {} points", where, max_points));
    Stroke stroke;
    if (const Json* radius = json.find("radius_mm")) {
        const double value = radius->is_number() ? radius->get<double>() : 0.0;
        if (!(value > 0.0 && value <= widest_mm))
            throw Error(fmt::format("{}: 'radius_mm' must be a number above 0, at most {:.0f}", where, widest_mm));
        stroke.radius = value * mm;
    }
    for (const Json& point : json["points_mm"]) stroke.points.push_back(point_of(point, where));
    return stroke;
}

SeedLabel label_of(const Json& json, std::size_t number, const std::string& file, SeedsUse use) {
    const std::string nth = fmt::format("{}: label {}", file, number + 1);
    file::refuse_unknown(json, nth, label_names);
    if (!json.is_object() || !json.contains("name") || !json["name"].is_string())
        throw Error(fmt::format("{} has no 'name'", nth));
    SeedLabel label;
    label.name = json["name"].get<std::string>();
    if (!is_label_name(label.name))
        throw Error(fmt::format("{}: the name must be one line of 1 to 200 characters", nth));
    const std::string where = fmt::format("{}: label '{}'", file, label.name);
    if (const Json* colour = json.find("colour")) label.colour = colour_of(*colour, where);
    if (!json.contains("strokes") || !json["strokes"].is_array() ||
        (json["strokes"].empty() && use == SeedsUse::segmentation))
        throw Error(fmt::format("{} has no strokes; paint at least one place of it", where));
    for (const Json& stroke : json["strokes"])
        label.strokes.push_back(stroke_of(stroke, fmt::format("{}, stroke {}", where, label.strokes.size() + 1)));
    return label;
}

}  // namespace

bool is_label_name(std::string_view name) {
    return !name.empty() && name.size() <= 200 && table::as_utf8(name) == name &&
           std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

bool is_seed_place(const Vec3& position) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(position[axis]) <= farthest_seed)) return false;
    return true;
}

std::vector<SeedLabel> seeds_of_text(std::string_view text, const std::string& file, SeedsUse use) {
    const Json json = file::parse_json(text, file);
    file::refuse_unknown(json, file, file_names);
    if (!json.is_object() || !json.contains("labels") || !json["labels"].is_array())
        throw Error(fmt::format("{}: expected {}", file, expected));
    file::require_lps_mm(json, "unit", file);
    const Json& list = json["labels"];
    if (list.size() < 2 && use == SeedsUse::segmentation)
        throw Error(fmt::format("{}: there {} {}; a segmentation needs seeds of at least two", file,
                                list.empty() ? "are" : "is", list.empty() ? "no labels" : "one label"));
    if (list.size() > max_labels)
        throw Error(fmt::format("{}: {} labels are too many; at most {}", file, list.size(), max_labels));
    std::vector<SeedLabel> labels;
    for (const Json& one : list) {
        SeedLabel label = label_of(one, labels.size(), file, use);
        if (std::any_of(labels.begin(), labels.end(), [&](const SeedLabel& l) { return l.name == label.name; }))
            throw Error(fmt::format("{}: there are two labels '{}'; give each its own name", file, label.name));
        labels.push_back(std::move(label));
    }
    return labels;
}

std::vector<SeedLabel> read_seeds(const std::filesystem::path& path, SeedsUse use) {
    return seeds_of_text(file::read_whole_file(path), path.string(), use);
}

void write_seeds(std::span<const SeedLabel> labels, const std::filesystem::path& path) {
    Json list = Json::array();
    for (const SeedLabel& label : labels) {
        Json one{{"name", label.name}};
        if (label.colour) {
            const auto byte = [](double c) { return static_cast<int>(std::lround(std::clamp(c, 0.0, 1.0) * 255.0)); };
            one["colour"] =
                fmt::format("#{:02x}{:02x}{:02x}", byte(label.colour->x), byte(label.colour->y), byte(label.colour->z));
        }
        Json strokes = Json::array();
        for (const Stroke& stroke : label.strokes) {
            Json points = Json::array();
            for (const Vec3& p : stroke.points)
                points.push_back(Json::array({rounded_mm(p.x), rounded_mm(p.y), rounded_mm(p.z)}));
            Json row = Json::object();
            row["radius_mm"] = rounded_mm(stroke.radius);
            row["points_mm"] = points;
            strokes.push_back(row);
        }
        one["strokes"] = strokes;
        list.push_back(one);
    }
    Json json = Json::object();
    json["frame"] = "LPS";
    json["unit"] = "mm";
    json["labels"] = list;
    file::write_whole_file(path, json.dump(1) + "\n");
}

}  // namespace tactus::segmentation
