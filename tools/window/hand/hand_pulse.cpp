// SPDX-License-Identifier: Apache-2.0
#include "tools/window/hand/hand_pulse.hpp"

#include <chrono>
#include <system_error>

namespace tactus::window {

namespace {

constexpr auto every = std::chrono::milliseconds(20);

}  // namespace

HandPulse::~HandPulse() {
    {
        const std::lock_guard lock(guard_);
        has_ended_ = true;
    }
    ends_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void HandPulse::say(const haptic::WantedHand& wanted) {
    const std::lock_guard lock(guard_);
    last_ = wanted;
    progress_ns_ = now_ns_();
    link_.wanted.write(wanted);
    // Most windows never have a hand.
    if (thread_.joinable()) return;
    try {
        thread_ = std::thread([this] { beat(); });
    } catch (const std::system_error&) {
        // Without it a slow picture lets go of the hand, which is safe.
    }
}

void HandPulse::forget() {
    const std::lock_guard lock(guard_);
    last_.reset();
}

void HandPulse::begin_picture() {
    const std::lock_guard lock(guard_);
    progress_ns_ = now_ns_();
    draws_ = true;
}

void HandPulse::end_picture() {
    const std::lock_guard lock(guard_);
    draws_ = false;
}

void HandPulse::repeat() {
    const std::lock_guard lock(guard_);
    const std::int64_t now = now_ns_();
    if (!draws_ || !last_ || now - progress_ns_ > longest_step_ns) return;
    last_->at_ns = now;
    link_.wanted.write(*last_);
}

void HandPulse::beat() {
    for (std::unique_lock lock(guard_); !ends_.wait_for(lock, every, [this] { return has_ended_; });) {
        lock.unlock();
        repeat();
        lock.lock();
    }
}

}  // namespace tactus::window
