// SPDX-License-Identifier: Apache-2.0
// The last word before a driver: every force of a live run passes here, from the thread of the tick or, when that one
// comes no more, from the watchdog's.
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

/// A fault of a device, for people.
struct DeviceFault {
    control::Fault reason = control::Fault::none;
    std::int64_t tick = 0;  ///< of the device's group
    double force_N = 0.0;   ///< that was on the hand the tick before
    std::int64_t over = -1;  ///< tick at which it was over, or another fault took its place; -1: it is not over
    std::int64_t number = 0;  ///< of the device's faults in this run, from 0 on
    std::array<char, 96> source{};  ///< whose values were late, cut to this length; "": the fault has no other source

    /// What happened, as a clause: "a value that the force depends on came too late (node 'ball' of the group '1 kHz')".
    std::string text() const;
};

/// Whether the hand feels forces, and since when.
struct DeviceState {
    control::ForceState state = control::ForceState::unknown;
    std::int64_t since = 0;  ///< tick of the device's group
};

/// What is finite and within what the device states it can bear; anything else becomes no force at all, so that not even
/// a node that writes to a device by itself gets round the limits.
Wrench clamp_to_device(const Wrench& wanted, const DeviceInfo& device) noexcept;

class DeviceGuard {
public:
    /// Before the run: an age of the last commit that means the tick's thread is gone.
    void set_limit(std::int64_t ns) noexcept { guard_.limit_ns = ns; }

    // Thread of the tick.
    /// Gives the device a force, unless the watchdog has it. May call the system, in the driver. When the driver takes
    /// longer than the limit, the watchdog gets the device as soon as it comes back.
    void commit(HapticDevice& device, const Wrench& wanted, std::int64_t now_ns) noexcept;
    /// Before the steps: the watchdog had the device since the last call, so that forces must come in anew.
    bool was_taken() noexcept;
    /// No tick comes any more, on purpose: the watchdog may fade what is left.
    void retire() noexcept { retired_.store(true, std::memory_order_release); }
    /// Keeps a fault to tell of, when the reason is new, and what the hand may expect.
    /// `source` as in DeviceFault.
    void note(control::Fault reason, control::ForceState state, std::int64_t tick, double force_N,
              std::string_view source = {}) noexcept;

    // Thread of the watchdog.
    /// Takes the device when its time has come, fades the force, gives the device back once the force is zero and the
    /// tick's thread asks for it again.
    void poll(HapticDevice& device, std::int64_t now_ns) noexcept;
    /// The force fades at once, on purpose, and stays away until `take_up`. Whoever asks sees to it that forces come in
    /// anew. Any thread; wait-free.
    void let_go() noexcept { lets_go_.store(true, std::memory_order_release); }
    void take_up() noexcept { lets_go_.store(false, std::memory_order_release); }
    /// The same while no node gives the device a force, as after an edit.
    void set_driven(bool is_driven) noexcept { is_left_.store(!is_driven, std::memory_order_release); }
    /// The force is to fade and come in anew, for a reason outside of the device. Any thread; wait-free.
    void ask_fade() noexcept { fade_asked_.store(true, std::memory_order_relaxed); }
    /// True once after `ask_fade`. Thread of the tick; wait-free.
    bool is_asked_to_fade() noexcept {
        return fade_asked_.load(std::memory_order_relaxed) && fade_asked_.exchange(false, std::memory_order_relaxed);
    }
    /// Retired, and no force is left.
    bool is_at_rest() const noexcept { return at_rest_.load(std::memory_order_acquire); }

    static constexpr std::size_t most_faults = 64;
    /// The newest of them, oldest first. Any thread, never in a tick.
    std::vector<DeviceFault> faults() const;
    /// Any thread.
    DeviceState state() const noexcept;

private:
    control::CommitGuard guard_;
    std::atomic<std::int64_t> asked_ns_{0};  // when the tick's thread was last refused
    std::atomic<bool> retired_{false}, at_rest_{false}, fade_asked_{false}, lets_go_{false}, is_left_{false};
    std::atomic<bool> is_let_go_{false};  // the watchdog has taken it on purpose
    std::atomic<bool> is_overdue_{false};  // a commit took too long: the watchdog is to take the device
    bool refused_ = false;  // thread of the tick
    control::Fault last_ = control::Fault::none;
    DeviceFault newest_;  // thread of the tick
    std::array<hosted::Seqlock<DeviceFault>, most_faults> faults_;  // a ring
    std::atomic<std::int64_t> count_{0};  // of all faults
    std::atomic<std::int64_t> state_{0};  // 16 * since + state
};

}  // namespace tactus::io
