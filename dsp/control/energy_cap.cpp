// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/energy_cap.hpp"

#include "dsp/core/rotation.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::control {
namespace {

/// Radius about a sample in which the truth lies: half the diagonal of a cell of the grid of encoder steps.
double radius_of(double step) noexcept { return 0.5 * std::sqrt(3.0) * step; }

/// Energy of a force in the coming hold, J, as a function of the fraction s of it that is given: s · along + s² · own.
struct Gift {
    double along = 0.0, own = 0.0;
    double trusted = 0.0;  // J, not counted: a slow hand is trusted to hold against it
    double all() const noexcept { return std::max(0.0, along + own); }
};

/// The hand before the coming hold, by the lightest hand that there may be.
struct Start {
    Vec3 velocity{0.0};  // measured, the mean of the last hold
    Vec3 gained{0.0};  // since, by the forces of that hold and those under way
    double fast = 0.0;
};

/// `yield` in s/kg: hold over mass. A hand that moves along the force, or fast, may be free; one that is slow is held by its
/// owner, except for what exceeds `trust` J.
Gift gift(const Vec3& force, const Start& start, double hold_s, double yield, double trust) noexcept {
    const double along = glm::dot(force, start.velocity) * hold_s,
                 gained = std::max(0.0, glm::dot(force, start.gained) * hold_s),
                 own = 0.5 * glm::dot(force, force) * yield * hold_s, light = gained + own;
    const double trusted = along > 0.0 ? 0.0 : (1.0 - start.fast) * std::min(trust, light);
    const double counted = light > 0.0 ? 1.0 - trusted / light : 1.0;
    return {along + counted * gained, counted * own, trusted};
}

}  // namespace

double EnergyCap::max_gain(const EnergyCapSettings& settings, double stiffness, double max_force) noexcept {
    const double hold = settings.period_s, delay = settings.delay_s, mass = settings.min_mass;
    const double force = std::min(max_force, std::sqrt(mass * stiffness) + stiffness * (hold + delay));
    const double reach = force * force * (hold + delay) / mass;
    return std::min(rest_J, reach * (hold + delay)) + force * settings.resolution + 0.2 * reach * delay;
}

void EnergyCap::prepare(const EnergyCapSettings& settings) noexcept {
    *this = EnergyCap{};
    settings_ = settings;
    hold_s_ = settings.period_s;
    start_over();
}

EnergyCap::Motion EnergyCap::follow(const Vec3& away, double step, double slow, Tracked& tracked,
                                    double elapsed_s) noexcept {
    const double far = glm::length(away), radius = radius_of(step) * (1.0 - tracked.fast);
    Motion motion;
    motion.done = far > radius ? away * (1.0 - radius / far) : Vec3(0.0);
    tracked.sum += motion.done;
    motion.velocity = tracked.velocity = tracked.window(tracked.sum, elapsed_s);
    const double now = std::clamp(glm::length(motion.velocity) / slow - 1.0, 0.0, 1.0);
    tracked.fast = std::max(now, tracked.fast * std::max(0.0, 1.0 - elapsed_s / calm_s));
    motion.fast = tracked.fast;
    motion.lag = (away - motion.done) * motion.fast;
    motion.doubt = motion.fast * step / static_cast<double>(std::max<std::size_t>(tracked.window.window(), 1));
    return motion;
}

/// The wrench that acted while the samples saw the last motion: that of `delay_s` ago.
Wrench EnergyCap::acting() const noexcept {
    const double ticks = std::clamp(settings_.delay_s / settings_.period_s, 0.0, static_cast<double>(max_delay));
    const auto whole = static_cast<std::size_t>(ticks);
    const double part = ticks - static_cast<double>(whole);
    return held_[whole] * (1.0 - part) + held_[whole + 1] * part;
}

/// Impulse of the forces that are under way when the coming hold begins to act, N·s and N·m·s.
Wrench EnergyCap::under_way() const noexcept {
    const double ticks = std::clamp(settings_.delay_s / settings_.period_s, 0.0, static_cast<double>(max_delay));
    Wrench sum;
    for (std::size_t i = 0; static_cast<double>(i) < ticks; ++i)
        sum = sum + held_[i] * (std::min(1.0, ticks - static_cast<double>(i)) * settings_.period_s);
    return sum;
}

/// Twice the deviation that the steps of the samples leave in the store; nothing of it for a slow hand, whose motion is
/// the least anyway.
double EnergyCap::reserve() const noexcept { return 2.0 * std::sqrt(doubt_) * std::max(place_.fast, turn_.fast); }

void EnergyCap::start_over() noexcept {
    place_ = turn_ = {};
    place_.window.prepare(radius_of(settings_.resolution));
    turn_.window.prepare(radius_of(settings_.angular_resolution));
    stored_ = doubt_ = damped_ = 0.0;
    started_ = false;
}

void EnergyCap::account(double work, double elapsed_s, double granted_W, bool was_taken) noexcept {
    grant_ = std::min(grant_ + granted_W * elapsed_s, granted_W * grant_window_s);
    const double speed = glm::length(place_.velocity), near_rest = std::clamp(2.0 - speed / calm_m_s, 0.0, 1.0);
    damped_ = damped_ * std::max(0.0, 1.0 - elapsed_s / grant_window_s) +
              near_rest * settings_.damping * speed * speed * elapsed_s;
    // Which part of the force was still there while it faded is not known: at worst all of it gave and none took.
    if (!std::isfinite(work) || (was_taken && work > 0.0)) return;
    const double given = std::max(0.0, -work), damped = std::min(damped_, given),
                 refund = std::min(grant_, given - damped);
    damped_ -= damped;
    grant_ -= refund;
    statistics_.granted += refund;
    stored_ = std::clamp(stored_ + work + damped + refund, -max_J, max_J);
    statistics_.max_stored = std::max(statistics_.max_stored, stored_);
    statistics_.max_returned = std::max(statistics_.max_returned, -stored_);
}

Wrench EnergyCap::tick(const Wrench& wanted, const Wrench& committed, const Pose& hand, double elapsed_s,
                       double granted_W, bool was_taken) noexcept {
    // Without a sample a force fades; at worst its first value gave all along what the next sample shows.
    if (!is_blind_) {
        std::shift_right(held_.begin(), held_.end(), 1);
        held_[0] = is_finite(committed) ? committed : Wrench{};
    }
    is_blind_ = !is_valid(hand);
    if (is_blind_ || !is_finite(wanted)) {
        was_blind_ = true;
        return wanted;
    }
    was_taken = was_taken || std::exchange(was_blind_, false);
    // No hand moves so far in a tick: the frame has changed, or a sample is broken.
    if (started_ && !(glm::length(hand.position - counted_.position) < farthest_m)) start_over();
    if (!started_) counted_ = hand;
    started_ = true;
    const double elapsed = elapsed_s > 0.0 ? elapsed_s : settings_.period_s;
    const Motion moved = follow(hand.position - counted_.position, settings_.resolution, slow_m_s, place_, elapsed);
    const Motion turned = follow(rotation_between(counted_.orientation, hand.orientation), settings_.angular_resolution,
                                 slow_rad_s, turn_, elapsed);
    counted_.position += moved.done;
    counted_.orientation = glm::normalize(rotation_by(turned.done) * counted_.orientation);
    // Ticks that were skipped lately may be skipped again.
    hold_s_ = std::max({elapsed, settings_.period_s, hold_s_ * (1.0 - elapsed)});
    const Wrench acted = acting();
    account(-glm::dot(acted.force, moved.done) - glm::dot(acted.torque, turned.done), elapsed, granted_W, was_taken);

    const Wrench change{held_[0].force - held_[1].force, held_[0].torque - held_[1].torque};
    doubt_ += (glm::dot(change.force, change.force) * settings_.resolution * settings_.resolution +
               glm::dot(change.torque, change.torque) * settings_.angular_resolution * settings_.angular_resolution) /
              12.0;

    const auto is_over = [](const Wrench& w) {
        return glm::length(w.force) < end_force && glm::length(w.torque) < end_torque;
    };
    if (is_over(wanted) && is_over(acted) && is_over(held_[0])) {
        stored_ = doubt_ = 0.0;
        force_level_ = torque_level_ = 1.0;
        return wanted;
    }
    // Against the force the whole of it is felt at once; a hand that rests feels it come back smoothly.
    force_level_ = glm::dot(acted.force, moved.done) < 0.0 ? 1.0 : std::min(1.0, force_level_ + elapsed / return_s);
    torque_level_ = glm::dot(acted.torque, turned.done) < 0.0 ? 1.0 : std::min(1.0, torque_level_ + elapsed / return_s);
    return bound({wanted.force * force_level_, wanted.torque * torque_level_}, moved, turned, wanted);
}

Wrench EnergyCap::bound(const Wrench& felt, const Motion& moved, const Motion& turned, const Wrench& wanted) noexcept {
    const Wrench acted = acting(), coming = under_way();
    double pending = 0.0;
    struct Side {
        Start start;
        double trust = 0.0, doubt = 0.0, yield = 0.0;
    };
    const auto side_of = [&](const Vec3& last, const Vec3& impulse, const Motion& motion, double least) {
        Start start{motion.velocity + motion.lag / hold_s_, last * (0.5 * hold_s_ / least), motion.fast};
        // What is under way acts first, as one force of that impulse over the delay.
        double trust = rest_J;
        if (settings_.delay_s > 0.0) {
            const Gift first =
                gift(impulse / settings_.delay_s, start, settings_.delay_s, settings_.delay_s / least, trust);
            pending += first.all();
            trust -= first.trusted;
        }
        start.gained += impulse / least;
        return Side{start, trust, motion.doubt, hold_s_ / least};
    };
    const Side force_side = side_of(acted.force, coming.force, moved, settings_.min_mass),
               torque_side = side_of(acted.torque, coming.torque, turned, settings_.min_inertia);
    const auto ahead = [&](const Vec3& force, const Side& side) {
        Gift g = gift(force, side.start, hold_s_, side.yield, side.trust);
        // The speed of a fast hand is known to a step in its window.
        if (g.all() > 0.0) g.along += glm::length(force) * side.doubt;
        return g;
    };
    const Gift by_force = ahead(felt.force, force_side), by_torque = ahead(felt.torque, torque_side);
    Gift both;
    for (const Gift& one : {by_force, by_torque})
        if (one.all() > 0.0) both = {both.along + one.along, both.own + one.own, both.trusted + one.trusted};
    const double available = std::max(0.0, stored_ + grant_ + damped_ - pending - reserve());
    Wrench out = felt;
    if (both.all() > available) {
        double share = 0.0;
        if (both.trusted > 0.0) {
            // A slow hand holds against the same energy whatever the force: there is no jump to zero where the trust ends.
            double high = 1.0;
            for (int n = 0; n < 24; ++n) {
                const double middle = 0.5 * (share + high);
                const bool fits =
                    ahead(felt.force * middle, force_side).all() + ahead(felt.torque * middle, torque_side).all() <=
                    available;
                (fits ? share : high) = middle;
            }
        } else if (both.along > 0.0) {
            share = available / both.all();
        } else {
            // A hand that still moves against the force: the share s with s · along + s² · own = available.
            const double root = std::sqrt(both.along * both.along + 4.0 * both.own * available);
            share = std::min(1.0, (root - both.along) / (2.0 * both.own));
        }
        if (by_force.all() > 0.0) out.force *= share, force_level_ *= share;
        if (by_torque.all() > 0.0) out.torque *= share, torque_level_ *= share;
        if (!std::isfinite(share)) {
            out = {};
            force_level_ = torque_level_ = 0.0;
        }
    }
    const double force = glm::length(wanted.force - out.force), torque = glm::length(wanted.torque - out.torque);
    statistics_.capped += force > 0.0 || torque > 0.0;
    statistics_.max_removed_force = std::max(statistics_.max_removed_force, force);
    statistics_.max_removed_torque = std::max(statistics_.max_removed_torque, torque);
    return out;
}

}  // namespace tactus::control
