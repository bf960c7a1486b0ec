// SPDX-License-Identifier: Apache-2.0
// Motion of the blade of a powered saw in response to its trigger, and detection of cutting.
#pragma once

#include <cstddef>
#include <optional>

namespace tactus::vibration {

enum class SawState { off, spin_up, idle, cutting, spin_down };

/// Behaviour of the saw; times in s.
struct SawBehaviour {
    double spin_up_time = 0.08;  ///< time constant of the rate after the trigger is pulled
    double spin_down_time = 0.15;  ///< and after it is released
    double load_on = 0.5;  ///< N: cutting starts above ...
    double load_off = 0.3;  ///< ... and ends below
    double fade_time = 0.02;  ///< cross-fade between recordings, or between free air and cutting
    double gain = 1.0;  ///< in addition to each recording's
};

/// Wait-free; does not allocate.
class BladeMotion {
public:
    static constexpr double greatest_rate = 1000.0;  ///< Hz

    BladeMotion() = default;
    /// `rate`: ticks per second.
    BladeMotion(double rate, const SawBehaviour& behaviour);

    /// Before a sample: takes the thrust (N), the trigger and the commanded rate (Hz, clamped to [0, greatest_rate]).
    /// `contact`: the blade touches bone, so that it cuts; without it the thrust decides.
    void command(double thrust, bool trigger, double commanded_rate, std::optional<bool> contact = {}) noexcept;
    /// After a sample: moves the blade on.
    void advance() noexcept { cycles_ += blade_rate_ / rate_; }

    SawState state() const { return state_; }
    bool loaded() const { return loaded_; }  ///< by the contact, or by the thrust with hysteresis
    double rate() const { return blade_rate_; }  ///< strokes per second, Hz, at this instant
    double cycles() const { return cycles_; }  ///< since the start

private:
    SawBehaviour behaviour_;
    double rate_ = 48000.0, up_share_ = 1.0, down_share_ = 1.0;
    double blade_rate_ = 0.0, cycles_ = 0.0;
    bool loaded_ = false;
    SawState state_ = SawState::off;
};

}  // namespace tactus::vibration
