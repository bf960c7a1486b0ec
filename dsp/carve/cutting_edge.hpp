// SPDX-License-Identifier: Apache-2.0
// The effective cutting edge: the position that the saw has reached, as opposed to where the blade is held.
#pragma once

#include "dsp/carve/cut_front.hpp"
#include "dsp/carve/round_front.hpp"
#include "dsp/carve/settings.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace tactus::carve {

/// One point of the edge, in the bone's frame, m.
struct EdgeNode {
    Vec3 at;           ///< effective position of the front's centre
    Vec3 target;  ///< position given by the blade
    bool cutting = false;  ///< bone limited its motion in the last step
    double travel = 0.0;  ///< m moved since the path was last cut
    bool seated = false;  ///< false: inside bone without air nearby; it neither moves nor cuts
    bool fresh = false;  ///< newly placed: no path leads here
};

/// The edge is a row of nodes one tooth pitch apart, longer than the blade by the stroke. As the stroke exceeds the
/// pitch, a tooth passes every point between nodes, so the row is one continuous edge of width `kerf` with a round
/// front. The teeth are at the foremost points of that front; the nodes are its centres, half a kerf behind. Each node
/// follows its target along the blade's y, then x, then z: in air immediately, in bone at most at the removal speed for
/// the density ahead of it. A node beyond the end of the bone is held back while bone is within one pitch of it, so
/// that the edge between it and its neighbour does not cut bone that neither of them has cut.
///
/// A Field has `double value(Vec3)`: distance, m, negative in bone; `double density(Vec3)`, kg/m³. Nothing allocates
/// after construction.
class CuttingEdge {
public:
    CuttingEdge() = default;

    CuttingEdge(const CarveSettings& settings, double voxel)
        : radius_(0.5 * settings.kerf), pitch_(settings.tooth_pitch), voxel_(voxel), ahead_(0.25 * voxel) {
        const double length = settings.blade_length + settings.stroke;
        const int spans = std::max(1, static_cast<int>(std::ceil(length / pitch_ - 1e-9)));
        pitch_ = length / spans;
        first_ = -0.5 * length;
        nodes_.resize(static_cast<std::size_t>(spans) + 1);
    }

    std::span<EdgeNode> nodes() noexcept { return nodes_; }
    std::span<const EdgeNode> nodes() const noexcept { return nodes_; }
    double pitch() const noexcept { return pitch_; }

    /// Places every node at its target or, if that is inside the bone, behind it along −y where the bone ends.
    template <class Field>
    void place(const Field& field, const Pose& pose) noexcept {
        frame(pose);
        for (std::size_t n = 0; n < nodes_.size(); ++n) {
            nodes_[n].target = local(pose, n);
            seat(field, nodes_[n]);
        }
    }

    /// Sets the nodes from a front that is advanced elsewhere. Nodes that the front lacks are not seated.
    void adopt(const CutFront& front) noexcept {
        for (std::size_t n = 0; n < nodes_.size(); ++n) {
            EdgeNode& node = nodes_[n];
            if (n >= static_cast<std::size_t>(front.count) || !front.is_seated(n)) {
                node.seated = false;
                continue;
            }
            const Vec3 at = front.at(n);
            if (!node.seated || front.is_fresh(n)) {
                node.fresh = true;
                node.travel = 0.0;
            } else {
                node.travel += glm::length(at - node.at);
            }
            node.at = node.target = at;
            node.seated = true;
        }
    }

    /// Moves the targets to `pose` and moves the nodes towards them. `removal` is the speed times the reference
    /// density, kg/(m² s); 0 when the saw does not run. Steps are at most 1 ms long.
    template <class Field>
    void follow(const Field& field, const Pose& pose, double dt, double removal) noexcept {
        frame(pose);
        const int steps = std::clamp(static_cast<int>(std::ceil(dt / longest_step - 1e-9)), 1, max_steps);
        for (std::size_t n = 0; n < nodes_.size(); ++n) {
            EdgeNode& node = nodes_[n];
            const Vec3 from = node.target;
            const Vec3 to = local(pose, n);
            if (glm::length(to - from) > std::max(fastest_hand * dt, 0.001)) {  // repositioned, not moved there
                node.target = to;
                seat(field, node);
                continue;
            }
            for (int step = 1; step <= steps; ++step) {
                node.target = step == steps ? to : from + (to - from) * (static_cast<double>(step) / steps);
                if (!node.seated) {
                    seat(field, node);
                } else {
                    const Vec3 before = node.at;
                    pursue(field, node, dt / steps, removal);
                    node.travel += glm::length(node.at - before);
                }
            }
        }
    }

private:
    static constexpr double longest_step = 0.001;  // s
    static constexpr int max_steps = 64;
    static constexpr double fastest_hand = 3.0;  // m/s
    static constexpr double reach = 0.030;  // m of bone out of which a repositioned blade is moved back
    static constexpr double max_aside = 0.010;  // m: a node farther from its target is detached
    static constexpr int max_moves = 32;

    void frame(const Pose& pose) noexcept {
        x_ = pose.rotate({1, 0, 0});
        y_ = pose.rotate({0, 1, 0});
        z_ = pose.rotate({0, 0, 1});
    }
    Vec3 local(const Pose& pose, std::size_t n) const noexcept {
        return pose.position + x_ * (first_ + pitch_ * static_cast<double>(n)) - y_ * radius_;
    }

    template <class Field>
    void seat(const Field& field, EdgeNode& node) noexcept {
        node.fresh = true;
        node.travel = 0.0;
        node.at = node.target;
        for (double back = 0.0; back <= reach;) {
            const Vec3 at = node.target - y_ * back;
            const double d = field.value(at);
            if (d >= radius_) {
                node.at = at;
                node.seated = true;
                return;
            }
            back += std::max(radius_ - d, 0.25 * voxel_);
        }
        node.seated = false;
    }

    template <class Field>
    void pursue(const Field& field, EdgeNode& node, double dt, double removal) noexcept {
        const Vec3 lag = node.target - node.at;
        const double distance = glm::length(lag);
        if (distance < 1e-12) return;
        if (field.value(node.at) > radius_ + distance + pitch_ + ahead_) {
            node.at = node.target;
            return;
        }
        const bool withdrawn = glm::dot(lag, y_) <= 0.0 && field.value(node.target) >= radius_;
        const double aside = std::sqrt(std::max(0.0, distance * distance - glm::dot(lag, y_) * glm::dot(lag, y_)));
        if (aside > max_aside || (withdrawn && distance > radius_)) return seat(field, node);
        if (withdrawn) {
            node.at = node.target;
            return;
        }
        bool held = false;
        const auto along = [&](const Vec3& axis, const Vec3& side, const Vec3& neighbour) {
            const double way = glm::dot(lag, axis);
            const double sign = way < 0.0 ? -1.0 : 1.0;
            held |= advance(field, node, axis * sign, side, neighbour, std::abs(way), dt * std::abs(way) / distance,
                            removal);
        };
        along(y_, z_, x_ * pitch_);
        along(x_, z_, Vec3(0.0));
        along(z_, y_, x_ * pitch_);
        node.cutting = held;
    }

    template <class Field>
    bool advance(const Field& field, EdgeNode& node, const Vec3& direction, const Vec3& side, const Vec3& neighbour,
                 double way, double time, double removal) const noexcept {
        // In contact the interpolated distance ripples: hysteresis between touching and free.
        const double slack = (node.cutting ? 0.15 : 0.02) * voxel_;
        for (int move = 0; move < max_moves && way > 1e-12; ++move) {
            const RoundFront::Contact front =
                RoundFront{radius_, ahead_}.look(field, node.at, direction, side, neighbour, slack);
            if (front.density > 0.0) {
                node.at += direction * std::min(way, removal / front.density * time);
                return true;
            }
            const double step = std::min(way, front.clear);
            node.at += direction * step;
            way -= step;
        }
        return false;
    }

    double radius_ = 0.0;
    double pitch_ = 0.0;
    double voxel_ = 0.0;
    double ahead_ = 0.0;
    double first_ = 0.0;
    Vec3 x_{1, 0, 0}, y_{0, 1, 0}, z_{0, 0, 1};
    std::vector<EdgeNode> nodes_;
};

}  // namespace tactus::carve
