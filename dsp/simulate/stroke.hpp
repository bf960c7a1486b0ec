// SPDX-License-Identifier: Apache-2.0
// Intention of a simulated operator who saws: approach, press, long strokes while feeding into the material, retract.
#pragma once

#include "dsp/core/constants.hpp"
#include "dsp/simulate/hand.hpp"
#include "dsp/simulate/tremor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace tactus::simulate {

/// The path of one cut in the device frame. Thrust is not prescribed: it results from the resistance to the feed.
struct StrokePlan {
    Pose start;                            ///< clear of the material
    Vec3 stroke_axis{1.0, 0.0, 0.0};       ///< unit, along the blade
    Vec3 feed_axis{0.0, 0.0, -1.0};        ///< unit, into the material
    double stroke_amplitude = 8e-3;        ///< m
    double stroke_rate = 0.7;              ///< Hz
    double thrust = 7.0;  ///< N at which the operator stops feeding
    double feed_speed = 30e-3;  ///< m/s without resistance
    double depth = 30e-3;  ///< m along feed_axis from start; when the hand reaches it, the cut is through: retract
    double retract_speed = 40e-3;          ///< m/s
    double feed_at = 0.5;  ///< s: leaves the start pose
    double stroke_at = 1.0;                ///< s: strokes begin; they reach full length within a second
    double retract_at = 60.0;              ///< s: retracts even if not through
    double trigger_on = 0.3;  ///< s
    double trigger_off = 1e9;  ///< s: trigger released then, or when back at the start pose
    /// s from a felt force to the operator's answer, up to `longest_reaction`: 0.1 to 0.2 s by touch. Until then only the
    /// grip answers, so after a sudden break-through the hand plunges for that long. 0: at once.
    double reaction_time = 0.0;
    /// Stiffness of the grip, N/m, by which an operator who reacts late feeds gently enough not to oscillate.
    double grip_stiffness = 800.0;
    Tremor tremor{};
    /// m that an operator who pressed goes on without feeling anything. Then the resistance is gone, because the cut is
    /// through or because the device gives no force: the operator pulls back to the start and tries again.
    double blind_advance = 6e-3;
    double pause = 2.5;  ///< s at the start before coming in anew: longer than a device takes until its forces return

    static constexpr double longest_reaction = 0.5;  ///< s
};

/// A force as it was `delay` s ago, to half a millisecond.
class ReactionDelay {
public:
    explicit ReactionDelay(double delay) noexcept
        : behind_(static_cast<std::size_t>(
              std::lround(std::clamp(delay, 0.0, StrokePlan::longest_reaction) / resolution))) {}

    double operator()(double h, double value) noexcept {
        if (behind_ == 0) return value;
        for (until_next_ -= h; until_next_ <= 0.0; until_next_ += resolution) {
            held_[at_] = value;
            at_ = (at_ + 1) % held_.size();
        }
        return held_[(at_ + held_.size() - 1 - behind_) % held_.size()];
    }

private:
    static constexpr double resolution = 0.5e-3;  // s
    std::array<double, static_cast<std::size_t>(StrokePlan::longest_reaction / resolution) + 2> held_{};
    std::size_t behind_, at_ = 0;
    double until_next_ = 0.0;
};

/// Model of the operator during a cut. The intended depth advances at feed_speed · (1 − felt / thrust): a muscle that
/// yields as the felt force nears its goal. In a material that is removed at speed v the thrust settles at
/// thrust · (1 − v / feed_speed), for any stiffness of the contact.
class StrokeOperator {
public:
    explicit StrokeOperator(const StrokePlan& plan = {}) : plan_(plan), noticed_(plan.reaction_time) {}

    /// See `advance` in hand.hpp.
    Intention operator()(double h, const Wrench& force, const Pose& hand) noexcept {
        const double middle = time_ + 0.5 * h;
        const double depth_speed = feed(h, force, hand);
        Intention intended;
        intended.pose.orientation = plan_.start.orientation;
        Vec3 shake, shake_speed;
        plan_.tremor.at(middle, shake, shake_speed);
        double along = 0.0, along_speed = 0.0;
        stroke(middle, along, along_speed);
        intended.pose.position = plan_.start.position + shake + plan_.feed_axis * (depth_ + 0.5 * h * depth_speed) +
                                 plan_.stroke_axis * along;
        intended.twist.linear = shake_speed + plan_.feed_axis * depth_speed + plan_.stroke_axis * along_speed;
        depth_ += h * depth_speed;
        time_ += h;
        return intended;
    }

    bool trigger() const noexcept {
        return time_ >= plan_.trigger_on && time_ < plan_.trigger_off && !(retracting_ && depth_ <= 0.0);
    }
    bool is_retracting() const noexcept { return retracting_; }
    double felt_thrust() const noexcept { return felt_; }  ///< N, as sensed
    double intended_depth() const noexcept { return depth_; }  ///< m
    double time() const noexcept { return time_; }  ///< s

private:
    static constexpr double sense_s = 0.03;  // proprioceptive delay as a low-pass; ten times faster than the feed loop
    static constexpr double ease_s = 1.0;

    double feed(double h, const Wrench& force, const Pose& hand) noexcept {
        felt_ += (noticed_(h, -glm::dot(force.force, plan_.feed_axis)) - felt_) * h / (sense_s + h);
        if (time_ < plan_.feed_at) return 0.0;
        const double reached = glm::dot(hand.position - plan_.start.position, plan_.feed_axis);
        if (!retracting_ && (time_ >= plan_.retract_at || reached >= plan_.depth)) {
            retracting_ = true;
            retract_from_ = time_;
            // From the hand's position, not from the intended depth: an operator releases before pulling out.
            depth_ = std::min(depth_, std::max(reached, 0.0));
        }
        if (!retracting_) notice_loss(reached);
        if (retracting_ || pulls_back_) return std::max(-plan_.retract_speed, -depth_ / h);
        return plan_.feed_speed * std::clamp((1.0 - felt_ / plan_.thrust) * calm(), -1.0, 1.0);
    }

    /// Detects that the resistance is gone. An operator who tries again and meets none at that place continues.
    void notice_loss(double reached) noexcept {
        if (pulls_back_) {
            if (depth_ > 0.0) waits_since_ = time_;
            pulls_back_ = time_ - waits_since_ < plan_.pause;
        } else if (felt_ >= 0.5 * plan_.thrust) {
            presses_ = true;
            pressed_at_ = reached;
        } else if (presses_ && felt_ < 0.05 * plan_.thrust && reached - pressed_at_ > plan_.blind_advance) {
            presses_ = false;
            pulls_back_ = true;
            waits_since_ = time_;
            depth_ = std::min(depth_, std::max(reached, 0.0));
        }
    }

    /// An integrator that acts late on a spring oscillates when its gain times the delay comes near π/2; this keeps 1/2.
    double calm() const noexcept {
        if (plan_.reaction_time <= 0.0) return 1.0;
        const double gain = plan_.feed_speed / plan_.thrust * plan_.grip_stiffness;
        return std::min(1.0, 0.5 / (gain * (plan_.reaction_time + sense_s)));
    }

    void stroke(double t, double& along, double& speed) const noexcept {
        const double since = t - plan_.stroke_at;
        if (since <= 0.0) return;
        const double rate = 2.0 * pi * plan_.stroke_rate;
        double gain = 1.0, gain_rate = 0.0;
        ease(since, gain, gain_rate);
        if (retracting_) {
            double rise = 0.0, rise_rate = 0.0;
            ease(t - retract_from_, rise, rise_rate);
            gain_rate = gain_rate * (1.0 - rise) - gain * rise_rate;
            gain *= 1.0 - rise;
        }
        along = plan_.stroke_amplitude * gain * std::sin(rate * since);
        speed = plan_.stroke_amplitude * (gain_rate * std::sin(rate * since) + gain * rate * std::cos(rate * since));
    }

    /// Half-cosine ramp from 0 to 1 within ease_s.
    static void ease(double since, double& value, double& rate) noexcept {
        const bool rising = since < ease_s;
        value = rising ? 0.5 - 0.5 * std::cos(pi * since / ease_s) : 1.0;
        rate = rising ? 0.5 * pi / ease_s * std::sin(pi * since / ease_s) : 0.0;
    }

    StrokePlan plan_;
    ReactionDelay noticed_;
    double time_ = 0.0, depth_ = 0.0, felt_ = 0.0, retract_from_ = 0.0;
    double pressed_at_ = 0.0, waits_since_ = 0.0;  // m along feed_axis, s
    bool retracting_ = false, presses_ = false, pulls_back_ = false;
};

}  // namespace tactus::simulate
