// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/vessel/vessel_real.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/vessel/tracker.hpp"
#include "tools/bench/vessel/ridge_tracker.hpp"
#include "tools/bench/vessel/vessel_region.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

namespace tactus::bench {

namespace {

using file::Json;

std::vector<Vec3> places_of(const vessel::Track& track) {
    std::vector<Vec3> places;
    for (const vessel::Branch& branch : track.branches)
        for (const vessel::Node& node : branch.nodes) places.push_back(node.position);
    return places;
}

double distance_to_piece(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 way = b - a;
    const double u = std::clamp(glm::dot(p - a, way) / std::max(1e-18, glm::dot(way, way)), 0.0, 1.0);
    return glm::length(p - a - u * way);
}

Json missing(const std::string& name) {
    return {{"case", name}, {"skipped", "not there: give the folder with --data or TACTUS_SHARED_DATA"}};
}

Json aorta(const std::filesystem::path& folder, const std::filesystem::path& pictures) {
    const std::filesystem::path scan = folder / "vessels/aorta_mra_vmtk.nrrd";
    const std::filesystem::path line_file = folder / "vessels/aorta_mra_vmtk_centerline_0.csv";
    if (!std::filesystem::exists(scan) || !std::filesystem::exists(line_file)) return missing("aorta_mra_vmtk");
    struct Reference {
        Vec3 place;
        double radius;
    };
    std::vector<Reference> line;
    std::istringstream text(file::read_whole_file(line_file));
    for (std::string row; std::getline(text, row);) {
        double x, y, z, r;
        if (std::sscanf(row.c_str(), "%*d,%lf,%lf,%lf,%lf", &x, &y, &z, &r) == 4)
            line.push_back({1e-3 * Vec3(x, y, z), 1e-3 * r});
    }
    const volume::Grid grid = volume::lps_grid(volume::read_volume(scan));
    const Vec3 seed = line[60].place;  // in the trunk
    const vessel::Track track = vessel::follow(grid, seed).track;
    // The ends of the reference line are those of vmtk's surface; its first and last sphere do not count.
    double squares = 0.0, worst = 0.0, wider = 0.0, least = 1.0, most = -1.0;
    int count = 0;
    for (std::size_t n = 3; n + 3 < line.size(); ++n) {
        double nearest = std::numeric_limits<double>::infinity(), radius = 0.0;
        for (const vessel::Branch& branch : track.branches)
            for (std::size_t k = 1; k < branch.nodes.size(); ++k) {
                const double d =
                    distance_to_piece(line[n].place, branch.nodes[k - 1].position, branch.nodes[k].position);
                if (d < nearest) nearest = d, radius = branch.nodes[k].radius;
            }
        squares += nearest * nearest;
        worst = std::max(worst, nearest);
        wider += radius - line[n].radius;
        least = std::min(least, radius - line[n].radius), most = std::max(most, radius - line[n].radius);
        ++count;
    }
    // Both iliac arteries at y = -100 mm: right and left of the middle.
    bool right = false, left = false;
    for (const Vec3& place : places_of(track)) {
        right = right || (std::abs(place.y + 0.100) < 0.004 && std::abs(place.x + 0.235) < 0.006);
        left = left || (std::abs(place.y + 0.100) < 0.004 && std::abs(place.x + 0.209) < 0.006);
    }
    double ridge = 0.0;
    const std::vector<Vec3> peer = follow_ridge(grid, seed, 4e-3);
    for (const Reference& at : line) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& place : peer) nearest = std::min(nearest, glm::length(place - at.place));
        ridge += nearest * nearest / double(line.size());
    }
    if (!pictures.empty()) draw_region(grid, Mask(grid.count(), 0), places_of(track), pictures / "aorta.png");
    return {{"case", "aorta_mra_vmtk"},
            {"branches", track.branches.size()},
            {"length_mm", track.length() * 1e3},
            {"both_iliacs", right && left},
            {"rms_mm", 1e3 * std::sqrt(squares / count)},
            {"worst_mm", 1e3 * worst},
            {"radius_minus_inscribed_mm", {1e3 * wider / count, 1e3 * least, 1e3 * most}},
            {"ridge_rms_mm", 1e3 * std::sqrt(ridge)}};
}

Json thorax(const std::filesystem::path& folder, const std::filesystem::path& pictures, const std::string& name,
            const Vec3& seed_mm, double low, std::size_t axis) {
    constexpr double high = 700.0;
    const std::filesystem::path scan = folder / "vessels/thorax_cta_dissection.nrrd";
    if (!std::filesystem::exists(scan)) return missing("thorax_cta_dissection " + name);
    const volume::Grid grid = volume::lps_grid(volume::read_volume(scan));
    const Vec3 seed = 1e-3 * seed_mm;
    vessel::TrackSettings settings;
    settings.clip_below = -150.0;
    const vessel::Track track = vessel::follow(grid, seed, settings).track;
    const Mask region = grown_region(grid, seed, low, high, axis), near = grown(grid, region);
    const vessel::Scan values(grid);
    int inside = 0, bright = 0, dim = 0, all = 0;
    for (const Vec3& place : places_of(track)) {
        ++all;
        inside += holds(grid, near, place);
        bright += values.any_value(place) > high;
        dim += values.any_value(place) < low;
    }
    const auto at = static_cast<int>(axis);
    double from = 1e9, to = -1e9;
    for (std::size_t n = 0; n < region.size(); ++n)
        if (region[n]) {
            const std::size_t width = static_cast<std::size_t>(grid.size[0]),
                              height = static_cast<std::size_t>(grid.size[1]);
            const double along = grid.position(static_cast<int>(n % width), static_cast<int>(n / width % height),
                                               static_cast<int>(n / (width * height)))[at];
            from = std::min(from, along), to = std::max(to, along);
        }
    double track_from = 1e9, track_to = -1e9;
    for (const Vec3& place : places_of(track))
        track_from = std::min(track_from, place[at]), track_to = std::max(track_to, place[at]);
    const std::vector<Vec3> peer = follow_ridge(grid, seed, 3e-3);
    int ridge = 0;
    for (const Vec3& place : peer) ridge += holds(grid, near, place);
    if (!pictures.empty()) draw_region(grid, region, places_of(track), pictures / (name + ".png"));
    return {{"case", "thorax_cta_dissection " + name},
            {"branches", track.branches.size()},
            {"length_mm", track.length() * 1e3},
            {"nodes", all},
            {"inside", all ? double(inside) / all : 0.0},
            {"in_bone_or_stent", bright},
            {"dimmer_than_lumen", dim},
            {axis == 2 ? "region_z_mm" : "region_y_mm", {from * 1e3, to * 1e3}},
            {axis == 2 ? "track_z_mm" : "track_y_mm", {track_from * 1e3, track_to * 1e3}},
            {"ridge_length_mm", peer.empty() ? 0.0 : 0.2 * 1.5 * double(peer.size())},
            {"ridge_inside", peer.empty() ? 0.0 : double(ridge) / double(peer.size())}};
}

}  // namespace

std::vector<Json> real_vessels(const std::filesystem::path& folder, const std::filesystem::path& pictures) {
    if (!pictures.empty()) std::filesystem::create_directories(pictures);
    std::vector<Json> rows;
    rows.push_back(aorta(folder, pictures));
    // Half between lumen and surroundings, HU; slices across z, for the coeliac artery across y.
    rows.push_back(thorax(folder, pictures, "carotid", Vec3(7.8, -179.2, 753.2), 237.0, 2));
    rows.push_back(thorax(folder, pictures, "subclavian", Vec3(12.3, -164.2, 757.7), 209.0, 2));
    rows.push_back(thorax(folder, pictures, "coeliac", Vec3(-2.7, -174.7, 549.2), 263.0, 1));
    return rows;
}

void print_real(const Json& row) {
    fmt::print("{}: {}\n", row["case"].as_text(), [&] {
        Json rest = Json::object();
        for (const auto& [key, value] : row.items())
            if (key != "case") rest[key] = value;
        return rest.dump();
    }());
    std::fflush(stdout);
}

}  // namespace tactus::bench
