// SPDX-License-Identifier: Apache-2.0
// Vibration of a powered saw at audio rate, from a model instead of the recordings themselves.
#pragma once

#include "dsp/vibration/blade_motion.hpp"
#include "dsp/vibration/saw_sounds.hpp"
#include "dsp/vibration/sinc_reading.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace tactus::vibration {

/// Orders follow the phase of the blade; the residual is noise through the model's filter, at 8 kHz, raised to the
/// output's rate by a windowed sinc. The sound is computed every 32 samples; levels are interpolated linearly in
/// between, so that changes of rate, load or density cause no step. The load and the density follow their inputs, and
/// cutting follows free air, within `fade_time`.
///
/// `tick` is wait-free, does not allocate, and depends on its arguments and the state only.
class ModelledSaw {
public:
    /// `rate`: sample rate of the output, at least 8 kHz. Throws Error as SawSounds does, and for another rate.
    /// Allocates.
    void prepare(double rate, const SawModel& model, const SawBehaviour& behaviour = {});

    /// One sample, in the model's unit. `load` in N (non-finite: none), `density` of the bone in kg/m³ (0: unknown),
    /// `commanded_rate` in Hz, clamped to [0, BladeMotion::greatest_rate].
    /// `contact`: the blade touches bone; without it the load decides.
    float tick(double load, double density, bool trigger, double commanded_rate,
               std::optional<bool> contact = {}) noexcept;

    const BladeMotion& blade() const { return blade_; }

private:
    static constexpr int interval = 32;  // samples between two computations
    static constexpr std::size_t kept = SawModelSize::lines;
    static_assert(kept >= reading_taps);

    void aim() noexcept;
    double orders() noexcept;
    double residual() noexcept;
    void add_noise() noexcept;

    SawSounds sounds_;
    SawBehaviour behaviour_;
    BladeMotion blade_;
    double rate_ = 48000.0, interval_share_ = 1.0, fade_step_ = 1.0;
    double load_ = 0.0, density_ = 0.0, wanted_load_ = 0.0, wanted_density_ = 0.0, cutting_ = 0.0;
    int until_next_ = 0;
    bool started_ = false;

    std::array<double, SawModelSize::max_orders> level_{}, step_{}, cos_{}, sin_{};
    std::size_t order_count_ = 0;

    SawSound sound_;
    std::array<double, SawModelSize::lines> predictor_{};
    double excitation_ = 0.0;  // rms
    std::array<double, kept> past_{};  // residual at the model's rate, newest first
    std::array<float, reading_taps> around_{};  // the same, oldest first
    double position_ = 0.0;  // model samples since the newest
    std::uint64_t drawn_ = 0;
};

}  // namespace tactus::vibration
