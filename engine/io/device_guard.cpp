// SPDX-License-Identifier: Apache-2.0
#include "engine/io/device_guard.hpp"

#include "dsp/core/clock.hpp"

#include <algorithm>

namespace tactus::io {

namespace {

bool is_none(const Wrench& w) noexcept { return w.force == Vec3(0.0) && w.torque == Vec3(0.0); }

}  // namespace

std::string DeviceFault::text() const {
    const std::string text = control::describe(reason);
    return source.front() == 0 ? text : text + " (" + source.data() + ")";
}

Wrench clamp_to_device(const Wrench& wanted, const DeviceInfo& device) noexcept {
    return control::stated_bounds(device.max_force, device.max_torque).clamp(wanted);
}

void DeviceGuard::commit(HapticDevice& device, const Wrench& wanted, std::int64_t now_ns) noexcept {
    if (is_overdue_.load(std::memory_order_acquire) || !guard_.begin()) {
        // A force that is kept away on purpose is no fault; what the hand is to feel once it is no more, is.
        const bool is_on_purpose =
            lets_go_.load(std::memory_order_acquire) || (is_let_go_.load(std::memory_order_acquire) && is_none(wanted));
        refused_ = refused_ || !is_on_purpose;
        asked_ns_.store(now_ns, std::memory_order_release);
        return;
    }
    const Wrench given = clamp_to_device(wanted, device.info());
    device.commit(given);
    if (!device.info().without_motors && steady_ns() - now_ns > guard_.limit_ns)
        is_overdue_.store(true, std::memory_order_release);
    guard_.end(given, now_ns);
}

bool DeviceGuard::was_taken() noexcept {
    const bool taken = refused_ || (guard_.is_taken() && !is_let_go_.load(std::memory_order_acquire));
    refused_ = false;
    return taken;
}

void DeviceGuard::note(control::Fault reason, control::ForceState state, std::int64_t tick, double force_N,
                       std::string_view source) noexcept {
    const auto told = state_.load(std::memory_order_relaxed);
    if (const auto now = static_cast<std::int64_t>(state); (told & 15) != now)
        state_.store(16 * tick + now, std::memory_order_release);
    if (reason == last_) return;
    const auto keep = [this] { faults_[static_cast<std::size_t>(newest_.number) % max_faults].write(newest_); };
    if (last_ != control::Fault::none) {
        newest_.over = tick;
        keep();
    }
    last_ = reason;
    if (reason == control::Fault::none) return;
    const std::int64_t count = count_.load(std::memory_order_relaxed);
    newest_ = {reason, tick, force_N, -1, count, {}};
    std::ranges::copy(source.substr(0, newest_.source.size() - 1), newest_.source.begin());
    keep();
    count_.store(count + 1, std::memory_order_release);
}

std::vector<DeviceFault> DeviceGuard::faults() const {
    std::vector<DeviceFault> all;
    const std::int64_t count = count_.load(std::memory_order_acquire);
    for (std::int64_t n = std::max<std::int64_t>(0, count - max_faults); n < count; ++n) {
        DeviceFault fault;
        std::uint64_t version = 0;
        // A newer one may have taken its place meanwhile.
        if (faults_[static_cast<std::size_t>(n) % max_faults].read(fault, version) && fault.number == n)
            all.push_back(fault);
    }
    return all;
}

DeviceState DeviceGuard::state() const noexcept {
    const std::int64_t packed = state_.load(std::memory_order_acquire);
    return {static_cast<control::ForceState>(packed & 15), packed >> 4};
}

void DeviceGuard::poll(HapticDevice& device, std::int64_t now_ns) noexcept {
    if (at_rest_.load(std::memory_order_relaxed)) return;
    const bool retired = retired_.load(std::memory_order_acquire),
               lets_go = lets_go_.load(std::memory_order_acquire) || is_left_.load(std::memory_order_acquire);
    const bool was_taken = guard_.is_taken();
    // Nobody feels the force of a device without motors: a late tick leaves it as it is.
    if (device.info().without_motors && !was_taken && !retired && !lets_go) return;
    Wrench out;
    if (lets_go && !was_taken) is_let_go_.store(true, std::memory_order_release);
    const bool at_once = retired || lets_go || is_overdue_.load(std::memory_order_acquire);
    if (!guard_.poll(now_ns, out, at_once)) {
        if (!was_taken) is_let_go_.store(false, std::memory_order_release);
        if (retired && !guard_.has_committed()) at_rest_.store(true, std::memory_order_release);
        return;
    }
    is_overdue_.store(false, std::memory_order_release);
    device.commit(out);
    if (!guard_.has_faded(now_ns)) return;
    if (retired) at_rest_.store(true, std::memory_order_release);
    else if (!lets_go && now_ns - asked_ns_.load(std::memory_order_acquire) <= guard_.limit_ns) {
        guard_.release();
        is_let_go_.store(false, std::memory_order_release);
    }
}

}  // namespace tactus::io
