// SPDX-License-Identifier: Apache-2.0
// A simulated operator that follows a list of targets: press, slide, rotate, insert.
#pragma once

#include "dsp/simulate/hand.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace tactus::simulate {

/// Intended pose of the hand at a time. Device frame.
struct HandTarget {
    double time = 0.0;  ///< s
    Pose pose;
};

/// Circular motion of the hand about the intended pose, and rotation about the x and y axes.
struct HandWiggle {
    double amplitude = 0.0;  ///< m, along x and y
    double rotation = 0.0;       ///< rad
    double rate = 1.5;       ///< Hz
};

/// Minimum-jerk motion from target to target; rests before the first and after the last.
class ScriptOperator {
public:
    /// `targets` in order of their times, at least one.
    ScriptOperator(std::vector<HandTarget> targets, const HandWiggle& wiggle)
        : targets_(std::make_shared<const std::vector<HandTarget>>(std::move(targets))), wiggle_(wiggle) {}

    /// See `advance` in hand.hpp.
    Intention operator()(double h, const Wrench&, const Pose&) noexcept {
        const double middle = time_ + 0.5 * h;
        time_ += h;
        return at(middle);
    }
    Pose start() const { return targets_->front().pose; }
    double time() const noexcept { return time_; }

    Intention at(double t) const noexcept {
        Intention intended = on_the_way(t);
        // Fades in over the first second.
        const double grown = std::clamp(t, 0.0, 1.0), growth = t > 0.0 && t < 1.0 ? 1.0 : 0.0;
        const double w = 2.0 * std::numbers::pi * wiggle_.rate, v = 1.3 * w;
        intended.pose.position += grown * wiggle_.amplitude * Vec3(std::sin(w * t), std::sin(v * t), 0.0);
        intended.twist.linear += wiggle_.amplitude * (growth * Vec3(std::sin(w * t), std::sin(v * t), 0.0) +
                                                      grown * Vec3(w * std::cos(w * t), v * std::cos(v * t), 0.0));
        const Vec3 nod = grown * wiggle_.rotation * Vec3(std::sin(v * t), std::sin(w * t), 0.0);
        intended.pose.orientation = glm::normalize(rotation_by(nod) * intended.pose.orientation);
        intended.twist.angular += wiggle_.rotation * (growth * Vec3(std::sin(v * t), std::sin(w * t), 0.0) +
                                                      grown * Vec3(v * std::cos(v * t), w * std::cos(w * t), 0.0));
        return intended;
    }

private:
    Intention on_the_way(double t) const noexcept {
        const auto& all = *targets_;
        const auto next = std::upper_bound(all.begin(), all.end(), t,
                                           [](double time, const HandTarget& target) { return time < target.time; });
        if (next == all.begin()) return {all.front().pose, {}};
        if (next == all.end()) return {all.back().pose, {}};
        const HandTarget &from = *(next - 1), &to = *next;
        const double span = to.time - from.time, s = (t - from.time) / span;
        const double share = s * s * s * (10.0 + s * (6.0 * s - 15.0));
        const double speed = 30.0 * s * s * (1.0 - s) * (1.0 - s) / span;
        const Vec3 translation = to.pose.position - from.pose.position;
        const Vec3 rotation = rotation_between(from.pose.orientation, to.pose.orientation);
        return {{from.pose.position + share * translation,
                 glm::normalize(rotation_by(share * rotation) * from.pose.orientation)},
                {speed * translation, speed * rotation}};
    }

    std::shared_ptr<const std::vector<HandTarget>> targets_;  // shared with the copy that `prepare` restores
    HandWiggle wiggle_;
    double time_ = 0.0;
};

}  // namespace tactus::simulate
