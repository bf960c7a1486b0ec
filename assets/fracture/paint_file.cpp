// SPDX-License-Identifier: Apache-2.0
#include "assets/fracture/paint_file.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/planning/faces.hpp"
#include "dsp/planning/surface_brush.hpp"
#include "dsp/snap/neighbours.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

constexpr double stroke_radius = 0.9e-3, stroke_step = 0.8e-3;  // m

std::vector<Vec3> strokes_of(const Json& json, const char* key, const std::string& file) {
    std::vector<Vec3> strokes;
    if (!json.contains(key)) return strokes;
    if (!json[key].is_array()) throw Error(fmt::format("{}: '{}' is no list of places", file, key));
    for (const Json& at : json[key]) {
        if (!at.is_array() || at.size() != 3 || !std::ranges::all_of(at, [](const Json& x) { return x.is_number(); }))
            throw Error(fmt::format("{}: a stroke of '{}' is no list of three numbers", file, key));
        strokes.push_back(1e-3 * Vec3(at[0].get<double>(), at[1].get<double>(), at[2].get<double>()));
    }
    return strokes;
}

}  // namespace

void paint_from_file(std::span<SurfacePoint> points, const std::filesystem::path& path, bool keep) {
    paint_from_text(points, read_whole_file(path), path.string(), keep);
}

void paint_from_text(std::span<SurfacePoint> points, std::string_view text, const std::string& file, bool keep) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || (!json.contains("paint") && !json.contains("erase")))
        throw Error(fmt::format(
            "{}: expected {{\"radius_mm\": r, \"paint\": [[x, y, z], ...], \"erase\": [[x, y, z], ...]}}", file));
    if (json.contains("radius_mm") && !json["radius_mm"].is_number())
        throw Error(fmt::format("{}: 'radius_mm' is no number", file));
    const double radius = 1e-3 * json.value("radius_mm", 1e3 * stroke_radius);
    if (!(radius > 0.0 && radius < 0.1))
        throw Error(fmt::format("{}: 'radius_mm' must be above 0 and below 100", file));
    const auto paint = strokes_of(json, "paint", file), erase = strokes_of(json, "erase", file);
    if (!keep)
        for (SurfacePoint& p : points) p.label = surface_label::none;
    SurfaceBrush brush({points.begin(), points.end()});
    for (const Vec3& place : paint) brush.stroke(place, radius, surface_label::fracture);
    for (const Vec3& place : erase) brush.stroke(place, radius, surface_label::none);
    std::ranges::copy(brush.points(), points.begin());
}

std::vector<PaintedFace> painted_faces(std::span<const SurfacePoint> points) {
    std::vector<PaintedFace> faces;
    for (const auto& indices : split_faces(points)) {
        PaintedFace face;
        face.points = indices.size();
        for (const std::size_t n : indices) {
            face.area += points[n].area;
            face.middle += points[n].area * points[n].position;
            face.normal += points[n].area * points[n].normal;
        }
        if (!(face.area > 0.0)) continue;
        face.middle /= face.area;
        const double length = glm::length(face.normal);
        if (length > 0.0) face.normal /= length;
        faces.push_back(face);
    }
    return faces;
}

std::vector<PaintedFace> write_paint_file(std::span<const SurfacePoint> points, const std::string& bone,
                                          const std::filesystem::path& path) {
    const auto rounded = [](double metres) { return std::round(metres * 1e6) * 1e-3; };
    Json json{
        {"bone", bone},           {"unit", "mm"},           {"frame", "LPS"},        {"radius_mm", stroke_radius * 1e3},
        {"paint", Json::array()}, {"erase", Json::array()}, {"faces", Json::array()}};
    const std::vector<PaintedFace> faces = painted_faces(points);
    for (const PaintedFace& f : faces)
        json["faces"].push_back({{"area_mm2", std::round(f.area * 1e7) * 0.1},
                                 {"middle_mm", {rounded(f.middle.x), rounded(f.middle.y), rounded(f.middle.z)}},
                                 {"normal", {f.normal.x, f.normal.y, f.normal.z}}});
    // A stroke for each painted point that no stroke before it is near to.
    std::vector<SurfacePoint> painted;
    for (const SurfacePoint& p : points)
        if (p.label == surface_label::fracture) painted.push_back(p);
    std::vector<char> covered(painted.size(), 0);
    if (!painted.empty()) {
        const Neighbours neighbours(painted, stroke_step);
        for (std::size_t n = 0; n < painted.size(); ++n) {
            if (covered[n]) continue;
            neighbours.around(n, [&](std::size_t m) { covered[m] = 1; });
            const Vec3& p = painted[n].position;
            json["paint"].push_back({rounded(p.x), rounded(p.y), rounded(p.z)});
        }
    }
    write_whole_file(path, json.dump(1) + "\n");
    return faces;
}

}  // namespace tactus
