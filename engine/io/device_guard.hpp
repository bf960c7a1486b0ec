// SPDX-License-Identifier: Apache-2.0
// The last stage before a driver: every force of a live run passes it, from the tick thread or, if that one hangs, from
// the watchdog's thread.
#pragma once

#include "devices/hosted/seqlock.hpp"
#include "dsp/control/commit_guard.hpp"
#include "dsp/control/force_limiter.hpp"
#include "dsp/control/force_state.hpp"
#include "graph/node/device.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::io {

/// A fault of a device, for messages.
struct DeviceFault {
    control::Fault reason = control::Fault::none;
    std::int64_t tick = 0;  ///< of the device's group
    double force_N = 0.0;  ///< on the hand in the previous tick
    std::int64_t over = -1;  ///< tick at which it ended or another fault replaced it; -1: still active
    std::int64_t number = 0;  ///< of the device's faults in this run, counted from 0
    std::array<char, 96> source{};  ///< the source whose values were late, cut to this length; "": none

    /// Describes the fault as a clause: "a value that the force depends on came too late (node 'ball' of the group '1
    /// kHz')".
    std::string text() const;
};

/// Whether the hand receives forces, and since when.
struct DeviceState {
    control::ForceState state = control::ForceState::unknown;
    std::int64_t since = 0;  ///< tick of the device's group
};

/// Limits a wrench to the maximum that the device states. A wrench that is not finite becomes zero. Even a node that
/// writes to a device directly cannot exceed the limits.
Wrench clamp_to_device(const Wrench& wanted, const DeviceInfo& device) noexcept;

class DeviceGuard {
public:
    /// Before the run: sets the age of the last commit from which the tick thread counts as hanging.
    void set_limit(std::int64_t ns) noexcept { guard_.limit_ns = ns; }

    // Thread of the tick.
    /// Sends a force to the device, unless the watchdog controls it. The driver may make system calls. If the driver
    /// takes longer than the limit, the watchdog takes control as soon as the driver returns.
    void commit(HapticDevice& device, const Wrench& wanted, std::int64_t now_ns) noexcept;
    /// Before the steps: true if the watchdog has had the device since the last call, so that forces must ramp in
    /// again.
    bool was_taken() noexcept;
    /// No further ticks will come, on purpose: the watchdog may fade the remaining force.
    void retire() noexcept { retired_.store(true, std::memory_order_release); }
    /// Records a fault if its reason is new, and the state of the force. `source` as in DeviceFault.
    void note(control::Fault reason, control::ForceState state, std::int64_t tick, double force_N,
              std::string_view source = {}) noexcept;

    // Thread of the watchdog.
    /// Takes control when the tick thread is late, fades the force, and returns control once the force is zero and the
    /// tick thread requests it again.
    void poll(HapticDevice& device, std::int64_t now_ns) noexcept;
    /// Fades the force immediately, on purpose, and keeps it at zero until `take_up`. The caller must ensure that
    /// forces ramp in again. Any thread; wait-free.
    void let_go() noexcept { lets_go_.store(true, std::memory_order_release); }
    void take_up() noexcept { lets_go_.store(false, std::memory_order_release); }
    /// The same while no node drives the device, as after an edit.
    void set_driven(bool is_driven) noexcept { is_left_.store(!is_driven, std::memory_order_release); }
    /// Requests that the force fades and ramps in again, for a reason outside of the device. Any thread; wait-free.
    void ask_fade() noexcept { fade_asked_.store(true, std::memory_order_relaxed); }
    /// True once after `ask_fade`. Thread of the tick; wait-free.
    bool is_asked_to_fade() noexcept {
        return fade_asked_.load(std::memory_order_relaxed) && fade_asked_.exchange(false, std::memory_order_relaxed);
    }
    /// True when retired and without force.
    bool is_at_rest() const noexcept { return at_rest_.load(std::memory_order_acquire); }

    static constexpr std::size_t max_faults = 64;
    /// The newest faults, oldest first. Any thread, never in a tick.
    std::vector<DeviceFault> faults() const;
    /// Any thread.
    DeviceState state() const noexcept;

private:
    control::CommitGuard guard_;
    std::atomic<std::int64_t> asked_ns_{0};  // time of the last rejected commit
    std::atomic<bool> retired_{false}, at_rest_{false}, fade_asked_{false}, lets_go_{false}, is_left_{false};
    std::atomic<bool> is_let_go_{false};  // the watchdog has taken it on purpose
    std::atomic<bool> is_overdue_{false};  // a commit took too long: the watchdog must take the device
    bool refused_ = false;  // thread of the tick
    control::Fault last_ = control::Fault::none;
    DeviceFault newest_;  // thread of the tick
    std::array<hosted::Seqlock<DeviceFault>, max_faults> faults_;  // a ring
    std::atomic<std::int64_t> count_{0};  // of all faults
    std::atomic<std::int64_t> state_{0};  // 16 * since + state
};

}  // namespace tactus::io
