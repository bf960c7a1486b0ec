// SPDX-License-Identifier: Apache-2.0
#include "tools/window/slices/plan_outlines.hpp"

#include "dsp/reconstruction/section.hpp"
#include "tools/analysis/leaving.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::window {

namespace {

/// Farther than that from where it was scanned, a fragment is elsewhere.
constexpr double elsewhere = 0.1e-3;

/// The pieces of a section, one after another.
std::vector<Outline> chained(const reconstruction::Section& section) {
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<std::array<std::size_t, 2>> next(section.points.size(), {none, none});
    const auto link = [&](std::size_t from, std::size_t to) {
        (next[from][0] == none ? next[from][0] : next[from][1]) = to;
    };
    for (const auto& [a, b] : section.pieces) {
        link(a, b);
        link(b, a);
    }
    std::vector<bool> is_taken(section.points.size(), false);
    std::vector<Outline> lines;
    const auto follow = [&](std::size_t from) {
        Outline line;
        std::size_t before = none;
        for (std::size_t at = from; at != none && !is_taken[at];) {
            is_taken[at] = true;
            line.push_back(section.points[at]);
            const std::size_t to = next[at][0] != before ? next[at][0] : next[at][1];
            if (to == from && before != none) line.push_back(section.points[from]);
            before = at;
            at = to;
        }
        if (line.size() > 1) lines.push_back(std::move(line));
    };
    // Open lines from their ends, then the closed ones.
    for (std::size_t n = 0; n < next.size(); ++n)
        if (!is_taken[n] && (next[n][0] == none || next[n][1] == none)) follow(n);
    for (std::size_t n = 0; n < next.size(); ++n)
        if (!is_taken[n]) follow(n);
    return lines;
}

bool is_same(const Pose& a, const Pose& b) { return a.position == b.position && a.orientation == b.orientation; }

}  // namespace

std::vector<Outline> cut_outlines(const geometry::TriangleSurface& surface, const Pose& pose, Slice slice, double at) {
    Vec3 normal{0.0}, through{0.0};
    normal[axes_of(slice).normal] = 1.0;
    through[axes_of(slice).normal] = at;
    const Pose back = pose.inverse();
    std::vector<Outline> lines =
        chained(reconstruction::section_of(surface, {back.apply(through), back.rotate(normal)}));
    for (Outline& line : lines)
        for (Vec3& p : line) p = pose.apply(p);
    return lines;
}

const PlanOutlines::Surface* PlanOutlines::surface_of(const std::shared_ptr<const observe::SeenBody>& body) {
    if (!body || body->distance.values.empty()) return nullptr;
    Surface& surface = surfaces_[body->content_hash];
    if (surface.is_made) return &surface;
    if (!surface.making.is_busy()) {
        surface.body = body;
        surface.making.begin(analysis::Lane::scene,
                             analysis::leaving([body] { return geometry::iso_surface(body->distance, 0.0f, false); }));
    }
    if (!surface.making.is_ready()) return nullptr;
    surface.triangles = surface.making.take();
    surface.is_made = true;
    for (const Vec3& v : surface.triangles.vertices) surface.radius = std::max(surface.radius, glm::length(v));
    return &surface;
}

const std::vector<Outline>& PlanOutlines::lines_of(Cut& cut, std::uint64_t body, const Surface& surface,
                                                   const Pose& pose, Slice slice, double at) {
    if (cut.body == body && is_same(cut.pose, pose) && cut.at == at) return cut.lines;
    cut.body = body;
    cut.pose = pose;
    cut.at = at;
    if (std::abs(pose.position[axes_of(slice).normal] - at) > surface.radius) cut.lines.clear();
    else cut.lines = cut_outlines(surface.triangles, pose, slice, at);
    return cut.lines;
}

const std::vector<PlanOutlines::Piece>& PlanOutlines::cut(
    const std::map<std::size_t, render::SceneModel::PlanPiece>& pieces, Slice slice, double at) {
    found_.clear();
    auto& cuts = cuts_[static_cast<std::size_t>(slice)];
    for (const bool is_scanned : {true, false})
        for (const auto& [place, piece] : pieces) {
            const Surface* const surface = surface_of(piece.body);
            if (!surface) continue;
            const Pose& home = piece.body->home;
            const Quat turn = glm::conjugate(home.orientation) * piece.pose.orientation;
            const double moved = glm::length(home.position - piece.pose.position) +
                                 2.0 * surface->radius * glm::length(Vec3(turn.x, turn.y, turn.z));
            if (is_scanned && moved < elsewhere) continue;
            Cut& known = cuts[place][is_scanned ? 1 : 0];
            const auto& lines =
                lines_of(known, piece.body->content_hash, *surface, is_scanned ? home : piece.pose, slice, at);
            if (!lines.empty()) found_.push_back({&lines, piece.colour, piece.is_chosen && !is_scanned, is_scanned});
        }
    return found_;
}

}  // namespace tactus::window
