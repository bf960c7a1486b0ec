// SPDX-License-Identifier: Apache-2.0
// A powered saw at audio rate, played from recordings that all run on one phase of the blade.
#pragma once

#include "dsp/vibration/cycle_loop.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::vibration {

/// One recording of a saw at a steady rate, mono. The samples need to live only while `prepare` runs.
struct SawRecording {
    std::span<const float> samples;
    double sample_rate = 48000.0;         ///< Hz
    double reciprocation_rate = 0.0;  ///< strokes to and fro per second, Hz; corrected by ±2 % from the sound itself
    double load = 0.0;  ///< thrust on the blade, N; without meaning in free air
    bool cutting = false;  ///< in bone, else in free air
    double gain = 1.0;  ///< output per unit of sample: m/s² per full scale when calibrated
    std::size_t loop_begin = 0;  ///< samples to be used: [begin, end); end 0 means all
    std::size_t loop_end = 0;
};

enum class SawState { off, spin_up, idle, cutting, spin_down };

/// How the saw behaves; times in s.
struct SawBehaviour {
    double spin_up_time = 0.08;  ///< time constant of the rate after the trigger is pulled
    double spin_down_time = 0.15;  ///< and after it is released
    double load_on = 0.5;  ///< N: cutting begins above ...
    double load_off = 0.3;  ///< ... and ends below
    double fade_time = 0.02;  ///< cross-fade between recordings
    double gain = 1.0;  ///< on top of each recording's
};

/// Plays the recordings at the blade's rate. Output is in m/s² when the recordings' gains say so, else in full scale.
///
/// The nearest recorded rate is played; another takes over as soon as it is nearer by 2 %, and at 15 % of pitch change
/// in any case if one is within that. Between two recorded loads the mix follows the load. Each change is a cross-fade
/// of `fade_time` whose gains account for how far two recordings repeat each other, so the power does not dip or rise
/// on the way. Below the lowest recorded rate the level falls with the square of the rate, as the acceleration of a
/// stroke of constant length does. Without free-air recordings the cutting ones stand in 12 dB lower; without cutting
/// ones those in free air do as they are.
///
/// `tick` is wait-free, allocates nothing, and depends on its arguments and the state only.
class SawVoice {
public:
    static constexpr double greatest_rate = 1000.0;  ///< Hz, of the blade
    static constexpr double greatest_pitch_change = 0.15;
    static constexpr std::size_t most_recordings = 32;

    /// `rate`: samples per second of the output. Throws Error when there is no recording, a value is not positive and
    /// finite, or a recording is shorter than 8 cycles. Resamples and loops each recording, which allocates.
    void prepare(double rate, std::span<const SawRecording> recordings, const SawBehaviour& behaviour = {});

    /// One sample. `load` in N (not finite: none), `commanded_rate` in Hz, clamped to [0, greatest_rate].
    float tick(double load, bool trigger, double commanded_rate) noexcept;

    SawState state() const { return state_; }
    double reciprocation_rate() const { return blade_rate_; }  ///< Hz, at this instant
    bool running() const { return state_ != SawState::off; }  ///< the blade moves
    double phase() const { return cycles_; }  ///< cycles of the blade since the start
    /// Which recording of `prepare`'s list sounds loudest now; -1 when off.
    int loudest_recording() const;

private:
    struct Layer {
        std::size_t loop;  // in loops_
        double rate, load, amplitude;
        bool cutting;
        double level = 0.0;                 // rms
        double target = 0.0, weight = 0.0;  // shares in the mix
    };
    /// The layers of one recorded rate, one per load.
    struct Group {
        double rate = 0.0;
        double border = 0.0;  // square of the blade's rate from which the next group is nearer
        std::vector<std::size_t> layers;
    };

    void make_groups();
    void move_blade(bool trigger, double commanded_rate) noexcept;
    void choose_layers(double load) noexcept;
    const Group& choose_group() noexcept;
    void aim(Layer& layer, double share) noexcept;
    double mix() noexcept;
    std::span<const std::size_t> active() const noexcept { return {active_.data(), active_count_}; }

    std::vector<CycleLoop> loops_;
    std::vector<Layer> layers_;
    std::vector<double> likeness_;  // loops × loops
    std::vector<Group> groups_[2];  // free air, cutting; by rate
    std::array<std::size_t, 2 * most_recordings> active_{};  // layers that sound or are about to, in order
    std::size_t active_count_ = 0;
    SawBehaviour behaviour_;
    double rate_ = 48000.0, up_share_ = 1.0, down_share_ = 1.0, fade_step_ = 1.0, lowest_recorded_ = 1.0;
    double blade_rate_ = 0.0, cycles_ = 0.0;
    std::ptrdiff_t playing_[2] = {-1, -1};  // group in use: free air, cutting
    bool loaded_ = false;
    SawState state_ = SawState::off;
};

}  // namespace tactus::vibration
