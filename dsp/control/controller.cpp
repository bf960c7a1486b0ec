// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/controller.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::control {

namespace {

constexpr double max_force = 1e6, max_position = 1e3;  // N, m
constexpr int max_lowerings = 10;  // of a gain that is chosen here, by a fifth each

}  // namespace

LoopModel loop_of(const ControllerSettings& settings) noexcept {
    LoopModel loop = settings.loop;
    loop.max_speed = settings.max_speed;
    return loop;
}

/// The limit takes hundreds of eigenvalue estimates; it does not depend on the object's rest position or the gain.
double AdmittanceControl::limit_for(const ControllerSettings& settings) const noexcept {
    LoopModel loop = settings.loop;
    ObjectSettings object = settings.object;
    loop.gain = settings_.loop.gain;
    object.rest = settings_.object.rest;
    if (limit_ > 0.0 && loop == settings_.loop && object == settings_.object &&
        settings.max_speed == settings_.max_speed)
        return limit_;
    return switched_gain_limit(loop_of(settings), settings.object);
}

/// Between the gains that were simulated for the limit there may be one that does not settle.
bool AdmittanceControl::settles_at(double gain, const ControllerSettings& settings) const noexcept {
    if (!settings.object.one_sided || settings.allow_unstable) return true;
    LoopModel loop = loop_of(settings);
    loop.gain = gain;
    return settles(loop, settings.object);
}

bool AdmittanceControl::set(const ControllerSettings& settings) noexcept {
    if (!settings.object.is_renderable()) return false;
    const double limit = limit_for(settings);
    const bool is_chosen = !(settings.loop.gain > 0.0);
    double gain = is_chosen ? settings.gain_share * limit : settings.loop.gain;
    if (!settings.allow_unstable && !(gain > 0.0 && gain < limit)) return false;
    const bool is_known = engaged_ && gain == gain_ && limit == limit_;
    for (int lower = 0; !is_known && !settles_at(gain, settings); ++lower, gain *= 0.8)
        if (!is_chosen || lower == max_lowerings) return false;
    if (engaged_) {
        // The difference of both objects' positions under the present force decays slowly.
        VirtualObject old = object_, made = object_;
        made.set(settings.object, settings.loop.period);
        offset_ += old.step(force_) - made.step(force_);
    }
    object_.set(settings.object, settings.loop.period);
    settings_ = settings;
    limit_ = limit;
    gain_ = gain;
    return true;
}

double AdmittanceControl::tick(double force, double position, Fault sensed, int periods, bool slips) noexcept {
    // Forces and positions beyond any finger's would make the object overflow.
    const bool sane = std::abs(force) < max_force && std::abs(position) < max_position;
    if (sensed == Fault::none && !sane) sensed = Fault::not_finite;
    if (sensed == Fault::none && fault_ == Fault::none && is_stuck(force, position, slips))
        sensed = Fault::stuck_encoder;
    if (fault_ == Fault::none) fault_ = sensed;
    if (asked_ && sensed == Fault::none) fault_ = Fault::none;
    asked_ = false;
    if (sensed == Fault::none) position_ = position;
    if (fault_ != Fault::none) {
        engaged_ = false;
        told_ = 0.0;
        wanted_ = position_;
        loop_.rest();
        return 0.0;
    }
    return told_ = follow(force, position, periods);
}

double AdmittanceControl::follow(double force, double position, int periods) noexcept {
    const double period = settings_.loop.period;
    const int steps = std::clamp(periods, 1, 150);
    if (!engaged_) {
        object_.place(position);
        offset_ = position - object_.step(force);
        wanted_ = position;
        told_travel_ = seen_travel_ = 0.0;
        loop_.rest();
        engaged_ = true;
    } else {
        const double before = wanted_;
        for (int n = 0; n < steps; ++n) object_.step(force);
        offset_ *= settings_.blend > 0.0 ? std::exp(-steps * period / settings_.blend) : 0.0;
        // Below any encoder's resolution it becomes zero, so that it never becomes denormal.
        if (std::abs(offset_) < 1e-12) offset_ = 0.0;
        wanted_ = object_.position() + offset_;
        force_ = force;
        return loop_({gain_, settings_.loop.feed_forward, settings_.loop.feed_forward_lag, settings_.max_speed,
                      settings_.least_speed, settings_.loop.delay},
                     wanted_, position, (wanted_ - before) / steps, period);
    }
    force_ = force;
    return 0.0;
}

bool AdmittanceControl::is_stuck(double force, double position, bool slips) noexcept {
    // A motor that works against such a strong hand may stall without a fault.
    const bool stalled = told_ * force < 0.0 && std::abs(force) >= settings_.stall_force;
    if (slips || stalled || std::abs(told_) < settings_.stuck_speed) {
        told_travel_ = seen_travel_ = 0.0;
        return false;
    }
    told_travel_ += std::abs(told_) * settings_.loop.period;
    seen_travel_ += std::abs(position - position_);
    return told_travel_ > settings_.stuck_travel && !(seen_travel_ > 0.0);
}

}  // namespace tactus::control
