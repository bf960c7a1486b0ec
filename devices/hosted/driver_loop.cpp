// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/driver_loop.hpp"

#include "devices/haptic/catalogue.hpp"
#include "devices/hosted/placement.hpp"
#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>

namespace tactus::hosted {

namespace {

constexpr int priority = 82;  // above every group, below the watchdogs
constexpr std::int64_t step_ns = 1'000'000;
constexpr std::int64_t hold_again_ns = 10'000'000;
constexpr double longest_elapsed_s = 1.0;

double number_of(const std::string& word) {
    const double number = std::strtod(word.c_str(), nullptr);
    if (!(std::isfinite(number) && number > 0.0)) throw Error("the engine states no period");
    return number;
}

/// Only now: threads that a vendor's library made are as it made them.
void make_real_time() noexcept {
    ::mlockall(MCL_CURRENT | MCL_FUTURE);
    sched_param parameters{};
    parameters.sched_priority = priority;
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
}

}  // namespace

void DriverLoop::run() noexcept {
    try {
        open();
        serve();
    } catch (const Error& error) {
        fail(error);
    } catch (const std::exception& error) {
        fail(Error(error.what()));
    }
    if (device_) fade();
    device_.reset();
    is_over_.store(true, std::memory_order_release);
}

void DriverLoop::fail(const Error& error) noexcept {
    has_failed_ = true;
    try {
        send(socket_, error_words(error));
    } catch (...) {
        // The engine sees that the socket is closed.
    }
}

void DriverLoop::open() {
    const Received heard = receive(socket_, std::nullopt);
    std::span<const std::string> words = heard.said;
    if (heard.kind != Received::words || words.size() < 6 || words[0] != say_open)
        throw Error("the engine sent an invalid message");
    const std::string driver = words[1], owner = words[2];
    words = words.subspan(3);
    const SourceLocation where = take_location(words);
    std::vector<OptionText> settings;
    while (words.size() >= 6) {
        OptionText option{words[0], words[1], {}, words[2]};
        words = words.subspan(3);
        option.where = take_location(words);
        settings.push_back(std::move(option));
    }
    Options options(owner, std::move(settings), where);
    read_placement(options, driver);
    device_ = haptic::open_haptic_device(driver, where, options, [this](const std::string& name) {
        send(socket_, {say_resolve, name});
        const Received answer = receive(socket_, std::nullopt);
        if (answer.kind != Received::words) throw Error("the engine has ended");
        if (answer.said.front() == say_path && answer.said.size() == 2) return std::filesystem::path(answer.said[1]);
        throw error_of(answer.said);
    });
    options.finish();
    if (const auto* const pulled = dynamic_cast<const haptic::PulledDevice*>(device_.get())) pull_ = pulled->pull();
    const DeviceInfo& info = device_->info();
    gate_.bounds = control::stated_bounds(info.max_force, info.max_torque);
    gate_.is_felt = !info.without_motors;
    fingers_ = info.fingers;
    block_.info = pack(info);
    send(socket_, {say_ready});
}

void DriverLoop::prepare(const Words& said) {
    if (said.front() != say_prepare || said.size() != 3) throw Error("the engine sent an invalid message");
    const double period = number_of(said[1]);
    round_ns_ = std::max<std::int64_t>(std::llround(1e9 * number_of(said[2])), 20'000);
    // A slower engine commits less often; three ticks are what its own watchdog waits for.
    gate_.limit_ns = std::max<std::int64_t>(ForceGate{}.limit_ns, std::llround(3e9 * period));
    device_->prepare(period);
    last_ns_ = 0;
    is_prepared_ = true;
    make_real_time();
    round();
    block_.state.store(HostState::runs, std::memory_order_release);
    send(socket_, {say_prepared});
}

void DriverLoop::serve() {
    std::int64_t next = steady_ns();
    while (!must_end_.load(std::memory_order_acquire)) {
        const Received heard = receive(socket_, std::chrono::milliseconds(0));
        if (heard.kind == Received::closed) return;
        if (heard.kind == Received::words) prepare(heard.said);
        if (is_prepared_) round();
        const std::int64_t now = steady_ns();
        next += is_prepared_ ? round_ns_ : step_ns;
        if (next < now) next = now;
        sleep_until(next);
    }
}

void DriverLoop::round() noexcept {
    std::uint64_t number = force_number_;
    block_.force.read(force_, number);
    if (number != force_number_) heard_ns_.store(steady_ns(), std::memory_order_relaxed);
    force_number_ = number;
    const std::int64_t now = boot_ns();
    given_ = gate_.give(force_, number, now);
    device_->commit(given_);
    if (fingers_ > 0) give_drive(now);
    const double elapsed = last_ns_ == 0 ? 0.0 : static_cast<double>(now - last_ns_) * 1e-9;
    last_ns_ = now;
    SampleRecord record = pack(device_->acquire(std::min(elapsed, longest_elapsed_s)));
    record.holds_force = gate_.holds() ? 1 : 0;
    record.answers_ns = force_.committed_ns;
    record.published_ns = boot_ns();
    block_.sample.write(record);
    tell_pull();
}

void DriverLoop::tell_pull() noexcept {
    haptic::PulledHand hand;
    std::uint64_t number = 0;
    if (!pull_ || !pull_->read(hand, number) || number == pull_number_) return;
    pull_number_ = number;
    block_.pull.write(pack(hand));
}

/// Each drive of the engine once, since a line may be slow. If the engine is lost, a drive that
/// holds is sent repeatedly.
void DriverLoop::give_drive(std::int64_t now_ns) noexcept {
    std::uint64_t number = drive_number_;
    block_.drive.read(drive_, number);
    const bool is_new = number != drive_number_;
    drive_number_ = number;
    if (gate_.passes() && is_young(drive_.committed_ns, now_ns, gate_.limit_ns)) {
        if (is_new) device_->drive(unpack(drive_));
        moves_ = true;
        return;
    }
    if (!moves_ || now_ns - held_ns_ < hold_again_ns) return;
    held_ns_ = now_ns;
    MotorDrive hold;
    if (std::isfinite(drive_.cord)) hold.cord = drive_.cord;
    device_->drive(hold);
}

void DriverLoop::fade() noexcept {
    if (!is_prepared_) return;
    const Wrench from = given_;
    const std::int64_t begin = steady_ns();
    for (;;) {
        const std::int64_t now = steady_ns();
        const double left = control::fade_left(static_cast<double>(now - begin), static_cast<double>(gate_.fade_ns));
        if (left <= 0.0 || !is_finite(from)) break;
        device_->commit(from * left);
        sleep_until(now + step_ns);
    }
    device_->commit({});
    if (fingers_ == 0 || !moves_) return;
    MotorDrive hold;
    if (std::isfinite(drive_.cord)) hold.cord = drive_.cord;
    device_->drive(hold);
}

}  // namespace tactus::hosted
