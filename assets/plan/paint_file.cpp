// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/paint_file.hpp"

#include "assets/file/json.hpp"
#include "assets/file/json_frame.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/contact/neighbours.hpp"
#include "dsp/contact/scanned_border.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/faces.hpp"
#include "dsp/fit/surface_brush.hpp"
#include "dsp/geometry/point_tree.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tactus::plan {

namespace {

using file::Json;

constexpr double stroke_radius = 0.9e-3;  // m
constexpr double rounding = 2e-6;  // m, more than the rounding of a position and a radius in the file
constexpr double rim_share = 0.7;  // of the distance to the next unpainted point: the rim lies about half way

/// "bone" and "faces" are for people.
const std::vector<std::string> member_names{"radius_mm", "paint", "erase", "bone", "unit", "frame", "faces"};

struct Stroke {
    Vec3 place{0.0};
    double radius = stroke_radius;
};

double rounded_mm(double metres) { return std::round(metres * 1e6) * 1e-3; }

double radius_of(const Json& millimetres, const std::string& file, const char* what) {
    const double radius = millimetres.is_number() ? 1e-3 * millimetres.get<double>() : 0.0;
    if (!(radius > 0.0 && radius < 0.1))
        throw Error(fmt::format("{}: {} must be a number above 0 and below 100", file, what));
    return radius;
}

std::vector<Stroke> strokes_of(const Json& json, const char* key, double radius, const std::string& file) {
    std::vector<Stroke> strokes;
    if (!json.contains(key)) return strokes;
    if (!json[key].is_array()) throw Error(fmt::format("{}: '{}' is not a list of positions", file, key));
    for (const Json& at : json[key]) {
        if (!at.is_array() || (at.size() != 3 && at.size() != 4) ||
            !std::ranges::all_of(at, [](const Json& x) { return x.is_number(); }))
            throw Error(
                fmt::format("{}: a stroke of '{}' is not a list of three numbers, or four with its radius", file, key));
        strokes.push_back({1e-3 * Vec3(at[0].get<double>(), at[1].get<double>(), at[2].get<double>()),
                           at.size() == 4 ? radius_of(at[3], file, "the radius of a stroke") : radius});
    }
    return strokes;
}

/// Strokes that cover exactly the painted points. Strokes at the rim are smaller than in the middle.
std::vector<Stroke> covering_strokes(std::span<const contact::SurfacePoint> points) {
    std::vector<contact::SurfacePoint> painted;
    std::vector<Vec3> bare;
    for (const contact::SurfacePoint& p : points)
        if (p.label == contact::surface_label::fracture) painted.push_back(p);
        else bare.push_back(p.position);
    std::vector<Stroke> all, chosen;
    const geometry::PointTree nearest(bare);
    for (const contact::SurfacePoint& p : painted) {
        const double to_bare = bare.empty() ? 1.0 : glm::length(bare[nearest.nearest(p.position)] - p.position);
        all.push_back({p.position, std::clamp(rim_share * to_bare, rounding, stroke_radius)});
    }
    std::vector<std::size_t> widest_first(all.size());
    std::iota(widest_first.begin(), widest_first.end(), std::size_t{0});
    std::ranges::stable_sort(widest_first, [&](std::size_t a, std::size_t b) { return all[a].radius > all[b].radius; });
    const contact::Neighbours neighbours(painted, stroke_radius);
    std::vector<char> covered(painted.size(), 0);
    for (const std::size_t n : widest_first) {
        if (covered[n]) continue;
        // Strokes overlap, so that they also paint another sampling of the surface without holes.
        neighbours.around(n, [&](std::size_t m) {
            covered[m] |= m == n || glm::length(painted[m].position - all[n].place) < 0.9 * all[n].radius - rounding;
        });
        chosen.push_back(all[n]);
    }
    return chosen;
}

}  // namespace

void paint_from_file(std::span<contact::SurfacePoint> points, const std::filesystem::path& path, bool keep) {
    paint_from_text(points, file::read_whole_file(path), path.string(), keep);
}

void paint_from_text(std::span<contact::SurfacePoint> points, std::string_view text, const std::string& file,
                     bool keep) {
    const Json json = file::parse_json(text, file);
    file::refuse_unknown(json, file, member_names);
    if (!json.is_object() || (!json.contains("paint") && !json.contains("erase")))
        throw Error(fmt::format(
            "{}: expected {{\"radius_mm\": r, \"paint\": [[x, y, z], ...], \"erase\": [[x, y, z], ...]}}", file));
    file::require_lps_mm(json, "unit", file);
    const double radius =
        json.contains("radius_mm") ? radius_of(json["radius_mm"], file, "'radius_mm'") : stroke_radius;
    const auto paint = strokes_of(json, "paint", radius, file), erase = strokes_of(json, "erase", radius, file);
    if (!keep) contact::remove_paint(points);
    fit::SurfaceBrush brush({points.begin(), points.end()});
    for (const Stroke& s : paint) brush.stroke(s.place, s.radius, contact::surface_label::fracture);
    for (const Stroke& s : erase) brush.stroke(s.place, s.radius, contact::surface_label::none);
    std::ranges::copy(brush.points(), points.begin());
}

std::vector<PaintedFace> painted_faces(std::span<const contact::SurfacePoint> points) {
    std::vector<PaintedFace> faces;
    for (const auto& indices : fit::split_faces(points)) {
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

std::vector<PaintedFace> write_paint_file(std::span<const contact::SurfacePoint> points, const std::string& bone,
                                          const std::filesystem::path& path) {
    Json json{
        {"bone", bone},           {"unit", "mm"},           {"frame", "LPS"},        {"radius_mm", stroke_radius * 1e3},
        {"paint", Json::array()}, {"erase", Json::array()}, {"faces", Json::array()}};
    const std::vector<PaintedFace> faces = painted_faces(points);
    for (const PaintedFace& f : faces)
        json["faces"].push_back(
            {{"area_mm2", std::round(f.area * 1e7) * 0.1},
             {"middle_mm", {rounded_mm(f.middle.x), rounded_mm(f.middle.y), rounded_mm(f.middle.z)}},
             {"normal", {f.normal.x, f.normal.y, f.normal.z}}});
    for (const auto& [p, radius] : covering_strokes(points)) {
        json["paint"].push_back({rounded_mm(p.x), rounded_mm(p.y), rounded_mm(p.z)});
        if (radius < stroke_radius) json["paint"].back().push_back(rounded_mm(radius));
    }
    file::write_whole_file(path, json.dump(1) + "\n");
    return faces;
}

}  // namespace tactus::plan
