// SPDX-License-Identifier: Apache-2.0
// The newest sample and the newest force, between the thread of a vendor or a peer and the thread of the ticks. Neither
// waits for the other. What is old counts as gone: a sample is invalid after 20 ms, a force is 0 N after 10 ms.
#pragma once

#include "devices/haptic/pulled_hand.hpp"
#include "devices/hosted/force_gate.hpp"
#include "devices/hosted/seqlock.hpp"
#include "dsp/control/adaptive_window.hpp"
#include "dsp/core/clock.hpp"
#include "graph/node/device.hpp"

#include <atomic>
#include <cstdint>

namespace tactus::driver {

/// What a device says of itself at one time, in the device frame of Tactus: x to the right, y away from the user, z up;
/// m, rad, m/s, rad/s.
struct Reading {
    Pose pose;
    Twist twist;  ///< ignored unless has_twist
    std::uint32_t buttons = 0;
    bool has_twist = false;  ///< false: the velocity is estimated from the poses by an adaptive window
    bool is_valid = true;  ///< false: the device is there, but its pose is none, as before a calibration
};

/// What a device may be given.
struct ForceLimits {
    double force = 0.0, torque = 0.0;  ///< N, N·m; 0: none at all
    bool is_felt = true;  ///< false: without motors, an old force does not fade
};

class Exchange {
public:
    using Clock = std::int64_t (*)() noexcept;
    static constexpr std::int64_t oldest_sample_ns = 20'000'000;
    static constexpr std::int64_t oldest_force_ns = 5'000'000, force_fade_ns = 5'000'000;  ///< 0 N after both

    explicit Exchange(Clock now = boot_ns) noexcept : now_(now) {}

    /// Before the threads begin, and by the device's thread when a device is there again: forces begin anew with small
    /// ones. `noise` in m: most that a position is away from the truth; `angular_noise` in rad.
    void begin(const ForceLimits& limits, double noise, double angular_noise) noexcept;

    // The device's thread. Real-time; neither waits nor allocates.
    void publish(const Reading& reading) noexcept;
    /// The device is gone: samples are invalid at once.
    void publish_loss() noexcept;
    /// What the device is to give now: within the limits, finite, zero when the last commit is old.
    Wrench force() noexcept;

    // The thread of the ticks. Real-time; neither waits nor allocates.
    DeviceSample newest() noexcept;
    void commit(const Wrench& on_hand) noexcept;
    /// Period of the commits in s. One that is slower than 600 Hz makes a force old later: after three periods.
    void expect(double period_s) noexcept;

    /// Where a person wants the hand, of drivers that pull it there. The device's thread writes.
    haptic::PullLink pull;

    /// Samples published since the beginning. Any thread.
    std::int64_t published() const noexcept { return published_.load(std::memory_order_relaxed); }

private:
    struct Stored {
        double position[3], orientation[4], linear[3], angular[3];
        std::int64_t counter, at_ns;
        std::uint64_t buttons, is_valid;
    };
    void estimate(Reading& reading, std::int64_t now) noexcept;
    void store(const Reading& reading, std::int64_t now) noexcept;

    Clock now_;
    hosted::Seqlock<Stored> sample_;
    hosted::Seqlock<hosted::ForceRecord> force_;
    std::atomic<std::int64_t> published_{0}, oldest_ns_{oldest_force_ns};
    // The device's thread.
    hosted::ForceGate gate_;
    hosted::ForceRecord committed_;
    std::uint64_t commit_number_ = 0;
    control::AdaptiveWindow speed_, spin_;
    Quat turned_from_{1.0, 0.0, 0.0, 0.0};
    Vec3 turned_{0.0};
    Twist twist_;
    std::int64_t counter_ = 0, windowed_ns_ = 0;
    double noise_ = 0.0, angular_noise_ = 0.0;
    // The thread of the ticks.
    Stored newest_{};
    std::uint64_t number_ = 0;
};

}  // namespace tactus::driver
