// SPDX-License-Identifier: Apache-2.0
// A hand on a stiff wall through device_output and the guard of its device, on a clock that the test turns, while a random
// sequence of disturbances goes on. The same seed gives the same run to the bit.
#pragma once

#include "dsp/core/random.hpp"
#include "engine/io/device_guard.hpp"
#include "tests/engine/recovery/hand_rules.hpp"
#include "tests/support/node_harness.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace tactus::test {

/// A mass that an operator holds on a soft spring. x > 0 is inside of the wall, which begins at 0.
struct OperatedMass {
    static constexpr double mass = 0.3;  ///< kg, with the device
    static constexpr double grip = 200.0, damping = 4.0;  ///< N/m and N·s/m, of the operator
    static constexpr double fastest = 0.1;  ///< m/s, of where the operator wants to be

    double x = -5e-3, v = 0.0, held = -5e-3, wanted = -5e-3;

    double pull() const { return grip * (held - x) - damping * v; }
    /// Under a constant force; returns the energy that the force gave, J.
    double move(double force, double seconds);
};

/// What happened in a run, so that a test can tell that it tried something.
struct ShakenCounts {
    std::int64_t late = 0, pauses = 0, edits = 0, device_faults = 0, not_finite = 0, presses = 0;
    std::int64_t returns = 0, waits_for_person = 0, full_forces = 0;
    double max_gained_J = 0.0;  ///< by one contact
    double max_allowed_J = -1.0;  ///< the same, less what was allowed

    void add(const ShakenCounts& other);
};

class ShakenHand {
public:
    explicit ShakenHand(std::uint64_t seed);

    /// Runs for so long. The first rule that was broken, with seed and tick; empty: none.
    std::string run(double seconds);
    const ShakenCounts& counts() const { return counts_; }

private:
    struct Device final : HapticDevice {
        const DeviceInfo& info() const override { return own; }
        void prepare(double) override {}
        DeviceSample acquire(double) noexcept override { return {}; }
        void commit(const Wrench& wrench) noexcept override {
            given = wrench;
            was_given = true;
        }
        DeviceInfo own;
        Wrench given;
        bool was_given = false;
    };
    enum class Shake {
        stall,
        leaves_out,
        crowd,
        invalid,
        stale,
        silent,
        sound,
        spike,
        pause,
        edit,
        stiffness,
        press,
        not_finite
    };
    enum class Pause { runs, fades, stands, comes_back };

    double random() { return Random{seed_}.uniform(drawn_++); }
    double between(double low, double high) { return low + (high - low) * random(); }
    bool happens(double per_second) { return random() < per_second * 1e-3; }  ///< in this millisecond
    bool is_one_of(int n) { return random() * n < 1.0; }

    void make_node();
    void disturb();
    void disturb_once(Shake what);
    void operate();
    void pause_or_go_on();
    void tick();
    DeviceSample sample();
    double contact(const DeviceSample& now);
    /// A millisecond passes for the hand; the watchdog looks in the middle.
    void pass();
    void gain(double given_J);
    void allow(double seconds);

    const std::uint64_t seed_;
    std::uint64_t drawn_ = 0;
    Device device_;
    io::DeviceGuard guard_;
    std::unique_ptr<NodeHarness> node_;
    OperatedMass hand_;
    HandRules rules_;
    ShakenCounts counts_;
    std::string broken_;

    std::int64_t began_ns_ = 0, ms_ = 0;
    std::int64_t logical_ = 0, last_logical_ = -1;  // ticks; time that stands in a pause does not count
    std::int64_t held_up_until_ = 0, crowded_until_ = 0;  // the thread of the tick is late; often
    std::int64_t invalid_until_ = 0, stale_until_ = 0, silent_until_ = 0;  // the device
    std::int64_t spike_until_ = 0, nan_until_ = 0, nan_from_ = 0;  // the contact
    std::int64_t follow_at_ = -1, press_at_ = -1, next_wish_ = 0;
    std::int64_t counter_ = 0;
    Pose seen_;
    double touched_ = 0.0, asked_ = 0.0, spike_ = 0.0, stiffness_ = 1000.0, next_stiffness_ = 1000.0;
    int pressed_ = 0;
    bool is_busy_ = false, is_capped_ = true, wants_pause_ = false, edit_replaces_ = false;
    Pause pausing_ = Pause::runs;
    std::int64_t pause_ms_ = 0, stands_for_ = 0;
    std::int64_t edit_at_ = -1;  // when the plan changes, at the earliest; −1: no edit is on its way

    double gained_J_ = 0.0, taken_J_ = 0.0, damped_J_ = 0.0, allowed_J_ = 0.0;  // of this contact
    int without_force_ = 0;  // halves of a tick
};

}  // namespace tactus::test
