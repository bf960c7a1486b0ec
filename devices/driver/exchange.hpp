// SPDX-License-Identifier: Apache-2.0
// Exchanges the newest sample and the newest force between the thread of a device (of a vendor's library or a network
// client) and the tick thread. Neither waits for the other. Old values expire: a sample is invalid after 20 ms, a force
// is 0 N after 10 ms.
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

/// State reported by a device at one time, in the device frame of Tactus: x to the right, y away from the user, z up;
/// m, rad, m/s, rad/s.
struct Reading {
    Pose pose;
    Twist twist;  ///< ignored unless has_twist
    std::uint32_t buttons = 0;
    bool has_twist = false;  ///< false: the velocity is estimated from the poses by an adaptive window
    bool is_valid = true;  ///< false: the device is present but its pose is invalid, as before calibration
};

/// Limits of the force sent to a device.
struct ForceLimits {
    double force = 0.0, torque = 0.0;  ///< N, N·m; 0: none
    bool is_felt = true;  ///< false: no motors, so an old force does not fade
};

class Exchange {
public:
    using Clock = std::int64_t (*)() noexcept;
    static constexpr std::int64_t oldest_sample_ns = 20'000'000;
    static constexpr std::int64_t oldest_force_ns = 5'000'000, force_fade_ns = 5'000'000;  ///< 0 N after their sum

    explicit Exchange(Clock now = boot_ns) noexcept : now_(now) {}

    /// Call before the threads start, and from the device's thread when a device has returned: forces resume only after
    /// small ones. `noise`: largest error of a position, m; `angular_noise`: rad.
    void begin(const ForceLimits& limits, double noise, double angular_noise) noexcept;

    // The device's thread. Real-time safe: neither waits nor allocates.
    void publish(const Reading& reading) noexcept;
    /// The device is lost: samples become invalid immediately.
    void publish_loss() noexcept;
    /// Returns the force to send now: within the limits, finite, zero if the last commit is old.
    Wrench force() noexcept;

    // The tick thread. Real-time safe: neither waits nor allocates.
    DeviceSample newest() noexcept;
    void commit(const Wrench& on_hand) noexcept;
    /// Sets the period of the commits, s. For a rate below 600 Hz, a force expires after three periods instead.
    void expect(double period_s) noexcept;

    /// Target pose of the hand, for drivers that pull it there. Written by the device's thread.
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
