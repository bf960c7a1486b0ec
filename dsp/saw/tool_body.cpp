// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/tool_body.hpp"

#include "dsp/saw/lag_norm.hpp"
#include "dsp/saw/saw_shape.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::saw {

namespace {

constexpr double deepest_row = 5e-3;  // m behind the teeth: a long blade is guided near them
constexpr std::size_t guides = 44;  // points on each face there
// A corner of a cube sinks 0.43 mm into a blade of balls 1 mm apart before it touches one.
constexpr double spacing = 1e-3;  // m
// The round front of the teeth covers what lies before; a late version of the bone is that much behind a fast feed.
constexpr double clear_of_teeth = 1.6e-3;  // m
constexpr std::size_t tile_balls = 9;
constexpr int max_slides = 10;
constexpr double guide_slack = 0.03e-3;  // m by which balls are thinner in a guide, whose slot holds the blade

/// Bone and guide as a ball of the radius that it has in bone meets them.
struct Both {
    const volume::BoneSnapshot& bone;
    const PlacedSolid& guide;
    double more = 0.0;  // m of radius in the guide beyond that in bone

    double value(const Vec3& p) const noexcept { return std::min(bone.value(p), guide.value(p) - more); }
    volume::Sample sample(const Vec3& p) const noexcept {
        volume::Sample of_guide = guide.sample(p);
        of_guide.value -= more;
        const volume::Sample of_bone = bone.sample(p);
        return of_bone.value <= of_guide.value ? of_bone : of_guide;
    }
};

double nearest(const Solids& solids, const Vec3& p) noexcept {
    const double of_bone = solids.bone.value(p);
    return solids.guide ? std::min(of_bone, solids.guide->value(p)) : of_bone;
}

double coarsest(const volume::BoneSnapshot& bone) noexcept {
    const Vec3& size = bone.layout().spacing;
    return std::max({size.x, size.y, size.z, 1e-6});
}

}  // namespace

std::vector<BodyPoint> blade_body(const SawShape& shape, double stiffness) {
    std::vector<BodyPoint> points;
    const auto add = [&](const Vec3& local, double radius) {
        const double blade = lateral_stiffness(shape, local);
        points.push_back({local, radius, radius, blade / (blade + stiffness)});
    };
    for (std::size_t n = 0; n < guides; ++n)
        for (const double side : {0.5, -0.5})
            add({shape.length * (static_cast<double>(n) / (guides - 1) - 0.5),
                 -std::min(0.5 * shape.height, deepest_row), side * shape.thickness},
                0.0);
    const double radius = 0.5 * shape.thickness;
    const double width = std::max(shape.length - shape.thickness, 0.0);
    const auto columns = static_cast<std::size_t>(std::ceil(width / spacing)) + 1;
    const double back = -shape.height + radius;
    // Tiles of three by three: columns in threes, and along them rows in threes.
    for (std::size_t block = 0; block < columns; block += 3) {
        const auto rows = static_cast<std::size_t>(std::ceil(std::max(-back - clear_of_teeth, 0.0) / spacing)) + 1;
        for (std::size_t row = 0; row < rows; ++row)
            for (std::size_t column = block; column < std::min(block + 3, columns); ++column) {
                const double x =
                    columns > 1 ? width * (static_cast<double>(column) / static_cast<double>(columns - 1) - 0.5) : 0.0;
                const double front = std::max(back, -shape.behind(x) - clear_of_teeth);
                const double share = rows > 1 ? static_cast<double>(row) / static_cast<double>(rows - 1) : 1.0;
                add({x, front + (back - front) * share, 0.0}, radius);
            }
    }
    return points;
}

std::vector<BodyPoint> blade_front(const SawShape& shape, double stiffness) {
    std::vector<BodyPoint> points;
    const double radius = 0.5 * shape.thickness, width = std::max(shape.length - shape.thickness, 0.0);
    const auto columns = static_cast<std::size_t>(std::ceil(width / spacing)) + 1;
    for (std::size_t column = 0; column < columns; ++column) {
        const double x =
            columns > 1 ? width * (static_cast<double>(column) / static_cast<double>(columns - 1) - 0.5) : 0.0;
        const Vec3 local(x, -shape.behind(x) - radius, 0.0);
        const double blade = lateral_stiffness(shape, local);
        points.push_back({local, radius, radius, blade / (blade + stiffness)});
    }
    return points;
}

std::vector<BodyPoint> shaft_body(double ball, double radius, double length) {
    std::vector<BodyPoint> points;
    const auto count = static_cast<std::size_t>(std::ceil(length / spacing));
    for (std::size_t n = 1; n <= count; ++n)
        points.push_back({{0.0, -ball - length * static_cast<double>(n) / static_cast<double>(count) + radius, 0.0},
                          radius,
                          radius,
                          1.0});
    return points;
}

ToolBody::ToolBody(std::vector<BodyPoint> points, double stiffness, double kerf, bool is_pinched)
    : points_(std::move(points)), kerf_(kerf) {
    squares_.reserve(points_.size());
    held_.reserve(points_.size());
    for (std::size_t first = 0; first < points_.size(); first += tile_balls) {
        Tile tile{first, std::min(tile_balls, points_.size() - first)};
        const std::span balls = std::span(points_).subspan(tile.first, tile.count);
        for (const BodyPoint& p : balls) tile.centre += p.local / static_cast<double>(tile.count);
        for (const BodyPoint& p : balls)
            tile.reach = std::max(tile.reach, glm::length(p.local - tile.centre) + p.radius);
        tiles_.push_back(tile);
    }
    for (const BodyPoint& p : points_) reach_ = std::max(reach_, glm::length(p.local));
    // Largest curvature of ½‖u‖₈² of n lengths: 4 for 44 points, and 7·n^¼ if walls can pinch them from both sides, 22 for
    // 88 points.
    const double count = std::max(static_cast<double>(points_.size()), 1.0);
    spring_ = is_pinched ? stiffness / (22.0 * std::sqrt(std::sqrt(count / 88.0)))
                         : stiffness / (4.0 * std::sqrt(std::sqrt(count / 44.0)));
}

void ToolBody::set_pose(const Pose& pose) noexcept {
    origin_ = pose.position;
    axes_ = Mat3(pose.rotate({1, 0, 0}), pose.rotate({0, 1, 0}), pose.rotate({0, 0, 1}));
}

double ToolBody::square(const Vec3& lag, double bending) const noexcept {
    const double across = glm::dot(lag, axes_[2]);
    return glm::dot(lag, lag) - (1.0 - bending) * across * across;
}

/// Between the walls of a kerf the distance has the shape of a roof, whose ridge the interpolation between voxels cuts off by
/// up to half a voxel: 0.17 mm of the 0.5 mm in the middle of a kerf of 1 mm in voxels of 0.33 mm. A ball as thick as the
/// blade, 0.35 mm, stuck there.
void ToolBody::fit_to(double voxel) noexcept {
    if (!(kerf_ > 0.0) || voxel == voxel_) return;
    voxel_ = voxel;
    constexpr double cut_off = 0.52;  // voxels; the skin of a slide is in it
    for (BodyPoint& p : points_) p.radius = std::min(p.full, std::max(0.5 * kerf_ - cut_off * voxel, 0.5 * p.full));
}

bool ToolBody::is_free(const Solids& solids, const Pose& pose) noexcept {
    fit_to(coarsest(solids.bone));
    for (const Tile& tile : tiles_) {
        if (nearest(solids, pose.apply(tile.centre)) > tile.reach) continue;
        for (std::size_t n = tile.first; n < tile.first + tile.count; ++n) {
            const BodyPoint& p = points_[n];
            const Vec3 at = pose.apply(p.local);
            if (solids.bone.value(at) < p.radius) return false;
            if (solids.guide && solids.guide->value(at) < std::max(0.0, p.full - guide_slack)) return false;
        }
    }
    return true;
}

void ToolBody::seat(const Pose& pose) noexcept {
    set_pose(pose);
    for (Tile& tile : tiles_) tile.is_free = true, tile.is_near = false;
    held_.clear();
}

/// Balls that were not looked at are where the tool had them at its last pose.
void ToolBody::bring_up(Tile& tile) noexcept {
    if (tile.is_near) return;
    tile.is_near = true;
    for (std::size_t n = tile.first; n < tile.first + tile.count; ++n) points_[n].at = place(points_[n].local);
}

void ToolBody::carry(const Pose& pose) noexcept {
    for (Tile& tile : tiles_) bring_up(tile);
    const Vec3 from = origin_;
    const Mat3 before = axes_;
    set_pose(pose);
    for (BodyPoint& p : points_) {
        const Vec3 lag = (from + before * p.local - p.at) * before;
        p.target = place(p.local);
        p.at = p.target - axes_ * lag;
    }
}

void ToolBody::release(const Pose& pose, double kept) noexcept {
    for (Tile& tile : tiles_) bring_up(tile);
    set_pose(pose);
    held_.clear();
    for (std::size_t n = 0; n < points_.size(); ++n) {
        BodyPoint& p = points_[n];
        p.target = place(p.local);
        p.at = p.target + (p.at - p.target) * kept;
        if (p.at != p.target) held_.push_back(static_cast<std::uint32_t>(n));
    }
    for (Tile& tile : tiles_) tile.is_free = false;
}

void ToolBody::follow(const Solids& solids, const Pose& pose, bool running) noexcept {
    const double voxel = coarsest(solids.bone);
    fit_to(voxel);
    const Vec3 from = origin_;
    const Mat3 before = axes_;
    set_pose(pose);
    held_.clear();
    for (Tile& tile : tiles_) {
        const Vec3 centre = place(tile.centre);
        if (tile.is_free) {
            // The way of a ball is at most that of the centre and the turn about it.
            double way = glm::length(centre - (from + before * tile.centre));
            for (const int axis : {0, 1, 2}) way += tile.reach * glm::length(axes_[axis] - before[axis]);
            if (nearest(solids, centre) > tile.reach + way) {
                tile.is_near = false;
                continue;
            }
        }
        if (!tile.is_near) {
            tile.is_near = true;
            for (std::size_t n = tile.first; n < tile.first + tile.count; ++n)
                points_[n].at = from + before * points_[n].local;
        }
        tile.is_free = true;
        for (std::size_t n = tile.first; n < tile.first + tile.count; ++n) {
            BodyPoint& p = points_[n];
            p.target = place(p.local);
            const Vec3 last = from + before * p.local;
            if (solids.guide) {
                const double in_guide = std::max(0.0, p.full - guide_slack);
                step(Both{solids.bone, *solids.guide, in_guide - p.radius}, p, last, voxel, running);
            } else {
                step(solids.bone, p, last, voxel, running);
            }
            if (p.at == p.target) continue;
            tile.is_free = false;
            held_.push_back(static_cast<std::uint32_t>(n));
        }
    }
}

/// From where the last tick left it; `last`: where the tool had it then.
template <class Field>
void ToolBody::step(const Field& field, BodyPoint& p, const Vec3& last, double voxel, bool running) const noexcept {
    const double distance = glm::length(p.target - p.at);
    if (field.value(p.at) - p.radius > distance) {
        p.at = p.target;
        return;
    }
    // A slide ends after some voxels: too few for a fast hand.
    if (glm::length(p.target - last) > voxel && is_way_free(field, p.at, p.target, p.radius, 0.25 * voxel)) {
        p.at = p.target;
        return;
    }
    slide(field, p, voxel, running);
    unhook(field, p, voxel);
    // What rounding leaves of a lag is no contact.
    if (glm::length(p.target - p.at) < 1e-8) p.at = p.target;
}

/// Bone does not hold a tool back by its roughness: a ball that would hook in on the way out sinks in by a part of a voxel,
/// and the points that guide a blade in its kerf as far as they must.
template <class Field>
void ToolBody::unhook(const Field& field, BodyPoint& p, double voxel) const noexcept {
    const double back = glm::dot(p.target - p.at, axes_[1]);
    if (back >= 0.0) return;
    if (p.radius == 0.0) {
        p.at += axes_[1] * back;
        return;
    }
    const double rough = p.radius - 0.25 * voxel;
    const auto may_be_at = [&](const Vec3& to) {
        const double there = field.value(to);
        return there >= rough || there >= field.value(p.at);
    };
    // As far back as allowed, to a thousandth of the distance: a coarser search would release the ball in force steps.
    double inside = 1.0, free = 0.0;
    if (may_be_at(p.at + axes_[1] * back)) free = 1.0;
    for (int halving = 0; halving < 10 && free < 1.0; ++halving) {
        const double middle = 0.5 * (free + inside);
        (may_be_at(p.at + axes_[1] * (back * middle)) ? free : inside) = middle;
    }
    p.at += axes_[1] * (back * free);
}

template <class Field>
void ToolBody::slide(const Field& field, BodyPoint& p, double voxel, bool running) const noexcept {
    const double skin = 0.01 * voxel;
    for (int move = 0; move < max_slides; ++move) {
        const Vec3 lag = p.target - p.at;
        const double distance = glm::length(lag);
        if (distance < 1e-9) return;
        const volume::Sample here = field.sample(p.at);
        const double gap = here.value - p.radius;
        const double slope = glm::length(here.gradient);
        if (gap > skin || !(slope > 0.1)) {
            p.at += lag * std::min(1.0, std::max(gap, 0.1 * voxel) / distance);
            continue;
        }
        const Vec3 normal = here.gradient / slope;
        const double inward = glm::dot(lag, normal);
        if (inward >= 0.0) {  // out of the bone
            p.at += lag * std::min(1.0, std::max(gap, 0.25 * voxel) / distance);
            continue;
        }
        const Vec3 along = lag - normal * inward;
        const double way = glm::length(along), held = running ? 0.0 : dry_friction * -inward;
        if (way - held < 1e-9) return;
        Vec3 next = p.at + along * (std::min(way - held, 0.5 * voxel) / way);
        // Where the surface rises, up to it.
        const double low = std::min(gap, skin);
        const double sunk = low - (field.value(next) - p.radius);
        if (sunk > 0.0) next += normal * sunk;
        if (field.value(next) - p.radius < low - 1e-9 ||
            square(p.target - next, p.bending) >= square(p.target - p.at, p.bending))
            return;
        p.at = next;
    }
}

ToolBody::Sum ToolBody::push(const Vec3& about) noexcept {
    Sum sum;
    squares_.clear();
    for (const std::uint32_t n : held_) {
        const BodyPoint& p = points_[n];
        squares_.push_back(saturated_square(square(p.target - p.at, p.bending)));
    }
    const double norm = squared_norm8(squares_);
    if (!(norm > 0.0)) return sum;
    sum.energy = 0.5 * spring_ * norm;
    for (std::size_t k = 0; k < held_.size(); ++k) {
        const BodyPoint& p = points_[held_[k]];
        const Vec3 lag = (p.target - p.at) * axes_;
        const double raw = square(p.target - p.at, p.bending);
        const double spring = spring8(spring_, squares_[k], norm) * saturation_share(raw);
        const Vec3 force = axes_ * -Vec3(lag.x * spring, lag.y * spring, lag.z * (spring * p.bending));
        sum.wrench.force += force;
        sum.wrench.torque += glm::cross(p.at - about, force);
        sum.magnitudes += glm::length(force);
        sum.lag = std::max(sum.lag, std::sqrt(raw));
        ++sum.count;
    }
    return sum;
}

}  // namespace tactus::saw
