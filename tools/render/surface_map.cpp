// SPDX-License-Identifier: Apache-2.0
#include "tools/render/surface_map.hpp"

#include "dsp/core/error.hpp"
#include "dsp/fit/gap.hpp"
#include "tools/analysis/bone/intact_side.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/render/body_surface.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::render {

namespace {

// Told apart with most kinds of colour blindness.
const Vec3 nothing{0.97, 0.95, 0.86}, wide{0.78, 0.13, 0.10}, inside{0.10, 0.25, 0.70};

/// The vertices that are drawn, in the frame of the fragment's file.
std::vector<contact::SurfacePoint> vertices_of(const observe::SeenBody& body) {
    const BodySurface surface = make_body_surface(body, contact::make_voxmap(body.distance), Vec3(0.0), Vec3(0.0));
    std::vector<contact::SurfacePoint> points;
    for (const geometry::SurfaceVertex& v : surface.patch.vertices) {
        const Vec3 at(static_cast<double>(v.position[0]), static_cast<double>(v.position[1]),
                      static_cast<double>(v.position[2]));
        const Vec3 normal(v.normal[0], v.normal[1], v.normal[2]);
        contact::SurfacePoint point;
        point.position = body.home.apply(at);
        point.normal = body.home.rotate(normal / std::max(glm::length(normal), 1e-12));
        points.push_back(point);
    }
    return points;
}

}  // namespace

SurfaceMapper::SurfaceMapper(SurfaceMap::Kind kind, const plan::CasePlan& plan, const std::filesystem::path& folder)
    : kind_(kind) {
    if (kind == SurfaceMap::Kind::gaps) {
        fragments_ = analysis::load_fragments(plan, folder);
        return;
    }
    healthy_ = analysis::healthy_side(plan::state_of(plan), folder);
    if (!healthy_) throw Error("the plan has no healthy side; make one by 'tactus plan mirror'");
}

SurfaceMap SurfaceMapper::map(std::span<const std::shared_ptr<const observe::SeenBody>> bodies,
                              std::span<const std::optional<Pose>> poses, std::stop_token stop) const {
    SurfaceMap map;
    map.kind = kind_;
    for (std::size_t i = 0; i < std::min(bodies.size(), poses.size()) && !stop.stop_requested(); ++i) {
        // Of fragments with one content the first is drawn.
        if (!bodies[i] || map.distance.contains(bodies[i]->content_hash)) continue;
        const std::vector<contact::SurfacePoint> points = vertices_of(*bodies[i]);
        std::vector<float>& nearest = map.distance[bodies[i]->content_hash];
        nearest.assign(points.size(), std::numeric_limits<float>::infinity());
        if (!poses[i]) continue;
        if (healthy_) {
            std::ranges::transform(points, nearest.begin(), [&](const contact::SurfacePoint& point) {
                return static_cast<float>(healthy_->distance(poses[i]->apply(point.position)));
            });
            continue;
        }
        for (std::size_t other = 0; other < std::min(fragments_.size(), poses.size()); ++other) {
            if (other == i || !poses[other] || stop.stop_requested()) continue;
            const fit::SurfaceGap gap = fit::gap_between(points, *poses[i], fragments_[other].map, *poses[other]);
            // An overlap, the deepest first, comes before the smallest gap.
            for (std::size_t n = 0; n < points.size(); ++n) nearest[n] = std::min(nearest[n], gap.distance[n]);
        }
    }
    return map;
}

SurfaceMap make_surface_map(SurfaceMap::Kind kind, const plan::CasePlan& plan, const std::filesystem::path& folder,
                            std::span<const std::shared_ptr<const observe::SeenBody>> bodies, std::stop_token stop) {
    const plan::PlanState state = plan::state_of(plan);
    std::vector<std::optional<Pose>> poses;
    for (int n = 0; n < static_cast<int>(plan.fragments.size()); ++n) {
        poses.emplace_back();
        // The healthy side is seen on hidden ones, too, once they are shown.
        if (kind == SurfaceMap::Kind::healthy || !state.arrangement.is_hidden(n))
            poses.back() = state.arrangement.pose(n);
    }
    return SurfaceMapper(kind, plan, folder).map(bodies, poses, std::move(stop));
}

SurfaceMap::Kind parse_map_kind(const std::string& name) {
    if (name == "gaps") return SurfaceMap::Kind::gaps;
    if (name == "mirror") return SurfaceMap::Kind::healthy;
    throw Error(fmt::format("--map must be gaps or mirror, not '{}'{}", name,
                            did_you_mean(name, std::vector<std::string>{"gaps", "mirror"})));
}

Vec3 map_colour(double distance, double range) {
    return glm::mix(nothing, distance < 0.0 ? inside : wide, std::min(std::abs(distance) / range, 1.0));
}

std::vector<display::Legend::Scale> map_scales(SurfaceMap::Kind kind, double range) {
    const std::string most = fmt::format("{:.3g}", range * 1e3);
    if (kind == SurfaceMap::Kind::healthy) return {{"from the healthy side, mm", "0", most, nothing, wide}};
    return {{"gap, mm", "0", most, nothing, wide}, {"overlap, mm", "0", most, nothing, inside}};
}

}  // namespace tactus::render
