// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/recovery/shaken_hand.hpp"

#include "dsp/control/energy_cap.hpp"
#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::test {

namespace {

constexpr double tick_s = 1e-3;
constexpr double resolution = 20e-6;  // m
constexpr double device_force = 9.0;  // N
constexpr std::int64_t ns_per_ms = 1'000'000;
// As engine/run/pause_control.cpp: ms from the wish to the first tick that fades, to the last tick, and after the pause.
constexpr std::int64_t pause_lead = 1, pause_stop = 30, after_pause = 20;
constexpr std::int64_t edit_fade = 20;  // ms
// A force is held for so long without a look at the hand. The watchdog waits for 3 ms, looks once a millisecond, and takes
// 10 ms; a device is stale after 10 ticks, and a force fades within 10.
constexpr double let_go_s = 12e-3, watchdog_s = 16e-3, stale_s = 22e-3;

// What a contact may give beyond what it took: what the hand damps is refunded (EnergyCapSettings::damping) below
// 2 * EnergyCap::calm_m_s, and 5 % of a bounce for the extrapolated motion of its last holds.
constexpr double refunded = 2.0, refunded_below = 0.1;  // N·s/m, m/s
constexpr double of_taken = 0.05;
constexpr int over_after = 6;  // halves of a tick without force, after which a contact is over
// The motion of a slow hand is known to half the diagonal of an encoder step, 17 µm, on both sides: once in a contact, and
// each time that the hand turns round. 20 ms of refund may be left of before the contact.
constexpr double unseen = 2.0 * 17.4e-6;  // m
constexpr double known_J = device_force * unseen + refunded * refunded_below * refunded_below * 0.02;
// A hand at rest counts as held by its owner until it moves at 2 * EnergyCap::slow_m_s; two ticks later the force is less.
constexpr double found_out = 2.0 * control::EnergyCap::slow_m_s + 2.0 * tick_s * device_force / OperatedMass::mass;
constexpr double trusted_J = 0.5 * OperatedMass::mass * found_out * found_out;

}  // namespace

double OperatedMass::move(double force, double seconds) {
    constexpr int steps = 4;
    const double h = seconds / steps, before = x;
    for (int i = 0; i < steps; ++i) {
        held += std::clamp(wanted - held, -fastest * h, fastest * h);
        v += (force + pull()) / mass * h;
        x += v * h;
    }
    return force * (x - before);
}

void ShakenCounts::add(const ShakenCounts& other) {
    late += other.late, pauses += other.pauses, edits += other.edits, device_faults += other.device_faults;
    not_finite += other.not_finite, presses += other.presses, returns += other.returns;
    waits_for_person += other.waits_for_person, full_forces += other.full_forces;
    max_gained_J = std::max(max_gained_J, other.max_gained_J);
    max_allowed_J = std::max(max_allowed_J, other.max_allowed_J);
}

ShakenHand::ShakenHand(std::uint64_t seed) : seed_(seed) {
    device_.own = {.name = "shaken", .max_force = device_force, .damping = refunded, .resolution = resolution};
    // Ahead of the clock, so that no commit seems to have taken long.
    began_ns_ = steady_ns() + 1'000'000 * 1'000 * ns_per_ms;
    make_node();
}

void ShakenHand::make_node() {
    std::unique_ptr<NodeHarness> before = std::move(node_);
    node_ = std::make_unique<NodeHarness>("device_output", servo);
    if (before) node_->host.devices = std::move(before->host.devices);
    else node_->host.device("", DeviceUse::drive, {}).info = device_.own;
    const double max_force = std::array{4.0, 8.0, 12.0}[static_cast<std::size_t>(between(0.0, 3.0))];
    const double slew = std::array{0.5, 1.0, 3.0}[static_cast<std::size_t>(between(0.0, 3.0))];
    const int wait_ms = std::array{0, 10, 1000, 1000, 1000, 1500}[static_cast<std::size_t>(between(0.0, 6.0))];
    const int engage_ms = std::array{0, 100, 700}[static_cast<std::size_t>(between(0.0, 3.0))];
    is_capped_ = !is_one_of(4);
    node_->set("max_force", fmt::format("{} N", max_force))
        .set("slew", fmt::format("{} N/ms", slew))
        .set("recover_after", fmt::format("{} ms", wait_ms))
        .set("engage_time", fmt::format("{} ms", engage_ms))
        .set("energy_cap", is_capped_ ? "true" : "false")
        .set("recover", std::to_string(pressed_))
        .disconnect("granted");
    node_->device_feed = [](std::int64_t, DevicePort&) {};
    node_->feed<Wrench>("wrench", [this](std::int64_t) { return Wrench{{asked_, 0.0, 0.0}, {}}; });
    node_->prepare();
    rules_.take_over({std::min(max_force, device_force), slew, wait_ms, is_capped_});
}

/// What the force may give while nobody looks at the hand: it goes on with the speed that it has, and what the operator
/// does not hold of the force pushes it. 0.4 N: the operator may go on by 2 mm meanwhile.
void ShakenHand::allow(double seconds) {
    const double force = device_.given.force.x, along = force < 0.0 ? -1.0 : 1.0;
    const double speed = std::max(0.0, along * hand_.v);
    const double push = std::max(0.0, std::abs(force) + along * hand_.pull() + 0.4) / OperatedMass::mass;
    allowed_J_ += std::abs(force) * (speed * seconds + 0.5 * push * seconds * seconds);
}

void ShakenHand::disturb_once(Shake what) {
    const auto until = [&](double low, double high) { return ms_ + static_cast<std::int64_t>(between(low, high)); };
    switch (what) {
        case Shake::stall:
            held_up_until_ = until(2.0, 40.0);
            allow(watchdog_s);
            break;
        case Shake::leaves_out:
            held_up_until_ = until(1.0, 4.0);
            allow(watchdog_s);
            break;
        case Shake::crowd: crowded_until_ = until(500.0, 3000.0); break;
        case Shake::invalid:
            invalid_until_ = until(1.0, 50.0);
            allow(let_go_s);
            break;
        case Shake::stale:
            stale_until_ = until(1.0, 60.0);
            allow(stale_s);
            break;
        case Shake::silent: silent_until_ = until(1.0, 300.0); break;
        case Shake::sound: guard_.ask_fade(); break;
        case Shake::spike:
            spike_until_ = until(1.0, 30.0);
            spike_ = is_one_of(2) ? 1000.0 : -1000.0;
            break;
        case Shake::pause:
            if (pausing_ == Pause::runs) wants_pause_ = true;
            break;
        case Shake::edit:
            if (edit_at_ < 0 && pausing_ == Pause::runs) {
                edit_at_ = ms_ + edit_fade;
                edit_replaces_ = !is_one_of(3);
            }
            break;
        case Shake::stiffness:
            next_stiffness_ = std::array{500.0, 1000.0, 2000.0, 4000.0}[static_cast<std::size_t>(between(0.0, 4.0))];
            break;
        case Shake::press: press_at_ = ms_; break;
        case Shake::not_finite: nan_until_ = until(1.0, 20.0); break;
    }
}

void ShakenHand::disturb() {
    // Calm stretches let forces come back; in some runs there are few of them.
    if (ms_ % 1000 == 0) is_busy_ = random() < (is_one_of(3) ? 0.7 : 0.3);
    if (ms_ < crowded_until_ && ms_ >= held_up_until_ && happens(20.0)) disturb_once(Shake::leaves_out);
    if (ms_ == follow_at_) disturb_once(static_cast<Shake>(between(0.0, 12.0)));
    // Some causes come while forces are away already.
    if (ms_ >= nan_from_ && (rules_.has_lost() ? happens(3.0) : happens(0.05))) {
        nan_from_ = std::numeric_limits<std::int64_t>::max();
        disturb_once(Shake::not_finite);
    }
    if (rules_.waits_for_person() && press_at_ < ms_ && happens(0.5)) press_at_ = ms_ + 200;
    if (!is_busy_) return;
    constexpr std::array<std::pair<Shake, double>, 12> rates{{{Shake::stall, 0.25},
                                                              {Shake::leaves_out, 0.5},
                                                              {Shake::crowd, 0.05},
                                                              {Shake::invalid, 0.08},
                                                              {Shake::stale, 0.08},
                                                              {Shake::silent, 0.08},
                                                              {Shake::sound, 0.04},
                                                              {Shake::spike, 0.1},
                                                              {Shake::pause, 0.08},
                                                              {Shake::edit, 0.08},
                                                              {Shake::stiffness, 0.2},
                                                              {Shake::press, 0.03}}};
    for (const auto& [what, per_second] : rates)
        if (happens(per_second)) {
            disturb_once(what);
            if (is_one_of(2)) follow_at_ = ms_ + 1 + static_cast<std::int64_t>(between(0.0, 1700.0));
        }
}

void ShakenHand::operate() {
    if (ms_ < next_wish_) return;
    next_wish_ = ms_ + static_cast<std::int64_t>(between(100.0, 2500.0));
    hand_.wanted = is_one_of(3) ? -5e-3 : between(1e-3, 40e-3);
}

void ShakenHand::pause_or_go_on() {
    switch (pausing_) {
        case Pause::runs:
            if (!std::exchange(wants_pause_, false)) return;
            ++counts_.pauses;
            allow(let_go_s);
            guard_.let_go();
            break;
        case Pause::fades:
            if (ms_ < pause_ms_ + pause_stop || ms_ < held_up_until_) return;
            stands_for_ = static_cast<std::int64_t>(between(5.0, 2000.0));
            break;
        case Pause::stands:
            if (ms_ < pause_ms_ + stands_for_) return;
            guard_.take_up();
            break;
        case Pause::comes_back:
            if (ms_ < pause_ms_ + after_pause) return;
            break;
    }
    pausing_ = static_cast<Pause>((static_cast<int>(pausing_) + 1) % 4);
    pause_ms_ = ms_;
}

DeviceSample ShakenHand::sample() {
    DeviceSample now;
    if (ms_ >= stale_until_) {
        ++counter_;
        seen_.position.x = std::round(hand_.x / resolution) * resolution;
    }
    now.pose = seen_;
    now.counter = counter_;
    now.valid = ms_ >= invalid_until_;
    now.late = ms_ < silent_until_;
    now.taken = guard_.was_taken();
    now.sound_lost = guard_.is_asked_to_fade();
    return now;
}

/// The contact computes with the last good pose, as device_input gives it.
double ShakenHand::contact(const DeviceSample& now) {
    if (now.valid) touched_ = now.pose.position.x;
    const double change = next_stiffness_ - stiffness_;
    stiffness_ += std::clamp(change, -35.0, 35.0);  // over a tenth of a second
    if (ms_ < nan_until_) return std::numeric_limits<double>::quiet_NaN();
    if (ms_ < spike_until_) return spike_;
    return touched_ > 0.0 ? -stiffness_ * touched_ : 0.0;
}

void ShakenHand::tick() {
    const std::int64_t now_ns = began_ns_ + ms_ * ns_per_ms;
    if (pausing_ == Pause::stands) {
        guard_.commit(device_, {}, now_ns);
        return;
    }
    ++logical_;
    if (ms_ < held_up_until_) return;
    DevicePort& port = *node_->host.devices.at("");
    if (edit_at_ >= 0 && ms_ >= edit_at_ && port.hold_off && port.wrench.force.x == 0.0) {
        edit_at_ = -1;
        ++counts_.edits;
        nan_until_ = 0;  // mended
        if (edit_replaces_) make_node();
    }
    const bool pauses = pausing_ == Pause::comes_back || (pausing_ == Pause::fades && ms_ >= pause_ms_ + pause_lead);
    port.hold_off = pauses || edit_at_ >= 0;
    TickSeen seen;
    seen.ms = ms_;
    seen.logical = logical_;
    seen.left_out = last_logical_ < 0 ? 0 : logical_ - last_logical_ - 1;
    port.sample = seen.sample = sample();
    seen.is_held_off = port.hold_off;
    if (ms_ >= press_at_ && press_at_ >= 0) {
        press_at_ = -1;
        seen.is_pressed = true;
        ++counts_.presses;
        node_->set("recover", std::to_string(++pressed_));
    }
    seen.asked = asked_ = contact(port.sample);
    counts_.late += seen.sample.taken || seen.sample.late;
    counts_.device_faults += !seen.sample.valid || seen.sample.sound_lost;
    counts_.not_finite += !std::isfinite(asked_);
    const bool waited = rules_.waits_for_person();
    node_->left_out = [left_out = static_cast<int>(seen.left_out)](std::int64_t) { return left_out; };
    node_->run(1);
    node_->forget();
    rules_.tick(seen, port);
    counts_.waits_for_person += rules_.waits_for_person() && !waited;
    port.wrench = io::clamp_to_device(port.wrench, port.info);
    const Wrench before = device_.given;
    device_.was_given = false;
    guard_.commit(device_, port.wrench, now_ns);
    if (device_.was_given) rules_.give(device_.given.force.x, false, ms_);
    counts_.full_forces += std::abs(device_.given.force.x) > 1.0 && before.force.x == device_.given.force.x;
    last_logical_ = logical_;
}

void ShakenHand::pass() {
    for (const bool looks : {true, false}) {
        const double force = device_.given.force.x;
        const double before = hand_.v, given = hand_.move(force, 0.5 * tick_s);
        if (before * hand_.v < 0.0) allowed_J_ += std::abs(force) * unseen;
        if (force != 0.0 && std::abs(hand_.v) < refunded_below)
            damped_J_ += refunded * hand_.v * hand_.v * 0.5 * tick_s;
        gain(given);
        if (!looks) continue;
        device_.was_given = false;
        guard_.poll(device_, began_ns_ + ms_ * ns_per_ms + ns_per_ms / 2);
        if (device_.was_given) rules_.give(device_.given.force.x, true, ms_);
    }
}

void ShakenHand::gain(double given_J) {
    gained_J_ += given_J;
    taken_J_ = std::max(taken_J_, -gained_J_);
    const double bound = known_J + trusted_J + damped_J_ + allowed_J_ + of_taken * taken_J_;
    if (is_capped_) {
        counts_.max_gained_J = std::max(counts_.max_gained_J, gained_J_);
        counts_.max_allowed_J = std::max(counts_.max_allowed_J, gained_J_ - bound);
        if (gained_J_ > bound && broken_.empty())
            broken_ = fmt::format("a contact gave {:.3g} mJ more than it took, {:.3g} mJ are allowed", 1e3 * gained_J_,
                                  1e3 * bound);
    }
    // A force that turns round passes zero in the middle of a contact.
    without_force_ = device_.given.force.x == 0.0 ? without_force_ + 1 : 0;
    if (without_force_ > over_after) gained_J_ = taken_J_ = damped_J_ = allowed_J_ = 0.0;
}

std::string ShakenHand::run(double seconds) {
    const auto end = static_cast<std::int64_t>(seconds / tick_s);
    // Not in every run.
    nan_from_ = is_one_of(2) ? static_cast<std::int64_t>(between(0.3, 1.0) * static_cast<double>(end))
                             : std::numeric_limits<std::int64_t>::max();
    for (; ms_ < end; ++ms_) {
        disturb();
        operate();
        pause_or_go_on();
        tick();
        pass();
        const std::string& broken = broken_.empty() ? rules_.broken() : broken_;
        if (!broken.empty()) return fmt::format("seed {}, tick {} (ms {}): {}", seed_, logical_, ms_, broken);
    }
    counts_.returns = rules_.returns();
    return {};
}

}  // namespace tactus::test
