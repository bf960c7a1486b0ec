// SPDX-License-Identifier: Apache-2.0
// What a hand may feel, said once more beside the product: from what a device reported, what was asked for and what the
// device was given. Forces along one axis.
#pragma once

#include "graph/node/setup.hpp"

#include <cstdint>
#include <deque>
#include <string>

namespace tactus::test {

/// Of a device_output.
struct HandLimits {
    double max_force = 10.0;  ///< N
    double slew = 1.0;  ///< N per tick
    std::int64_t recover_after = 1000;  ///< ticks; 0: only by hand
    bool is_capped = true;
};

/// What a tick of a device_output was told.
struct TickSeen {
    std::int64_t ms = 0;  ///< that passed
    std::int64_t logical = 0, left_out = 0;  ///< ticks
    DeviceSample sample;
    double asked = 0.0;  ///< N
    bool is_held_off = false;
    bool is_pressed = false;  ///< a person lets forces return
};

class HandRules {
public:
    /// Forces are away because of lateness: they wait for 1 s on time and 0.5 s without force, and come in over 0.5 s.
    static constexpr std::int64_t on_time = 1000, quiet = 500, ramp = 500, window = 60'000, fade = 10;
    static constexpr std::size_t max_returns = 3;

    /// The node was made, or another has taken its place.
    void take_over(const HandLimits& limits);
    /// After a tick; `port` as the node left it.
    void tick(const TickSeen& seen, const DevicePort& port);
    /// The device was given a force.
    void give(double force, bool by_watchdog, std::int64_t ms);

    const std::string& broken() const { return broken_; }
    std::int64_t returns() const { return all_returns_; }
    bool waits_for_person() const { return is_late_ && needs_person_; }
    bool has_lost() const { return is_late_ || is_bad_ || is_nan_; }
    bool must_engage() const { return must_engage_; }

private:
    void note_lateness(const TickSeen& seen);
    void note_device(const TickSeen& seen);
    void note_loss(const TickSeen& seen);
    void come_back(const TickSeen& seen);
    void check_force(const TickSeen& seen, const DevicePort& port);
    void breaks(const char* rule) {
        if (broken_.empty()) broken_ = rule;
    }

    HandLimits limits_;
    std::string broken_;
    bool is_late_ = false, is_bad_ = false, is_nan_ = false, is_held_ = false;  // why forces are away
    bool must_engage_ = true, was_engaged_ = false;
    bool was_by_watchdog_ = false, comes_in_ = false, needs_person_ = false, needed_person_ = false, is_let_ = false;
    std::int64_t last_late_ = -1, last_bad_ = 0, counter_ = -1, repeats_ = 0, small_ticks_ = 0, ramped_ = 0;
    std::int64_t quiet_ticks_ = 0, pressed_ = 0, zero_by_ms_ = 0, all_returns_ = 0, given_ms_ = 0;
    double max_asked_ = 0.0, given_ = 0.0, wanted_ = 0.0, fades_from_ = 0.0;
    std::deque<std::int64_t> left_out_, returns_;
};

}  // namespace tactus::test
