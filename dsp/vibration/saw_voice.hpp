// SPDX-License-Identifier: Apache-2.0
// Vibration of a powered saw at audio rate, synthesised from recordings that share one phase of the blade.
#pragma once

#include "dsp/vibration/cycle_loop.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::vibration {

/// One mono recording of a saw at a steady rate. The samples are needed during `prepare` only.
struct SawRecording {
    std::span<const float> samples;
    double sample_rate = 48000.0;         ///< Hz
    double reciprocation_rate = 0.0;  ///< strokes per second, Hz; refined within ±2 % from the sound
    double load = 0.0;  ///< thrust on the blade, N; ignored in free air
    bool cutting = false;  ///< in bone, else in free air
    double gain = 1.0;  ///< output per unit of sample: m/s² per full scale when calibrated
    std::size_t loop_begin = 0;  ///< samples to use: [begin, end); end 0 means all
    std::size_t loop_end = 0;
};

enum class SawState { off, spin_up, idle, cutting, spin_down };

/// Behaviour of the saw; times in s.
struct SawBehaviour {
    double spin_up_time = 0.08;  ///< time constant of the rate after the trigger is pulled
    double spin_down_time = 0.15;  ///< and after it is released
    double load_on = 0.5;  ///< N: cutting starts above ...
    double load_off = 0.3;  ///< ... and ends below
    double fade_time = 0.02;  ///< cross-fade between recordings
    double gain = 1.0;  ///< in addition to each recording's
};

/// Plays the recordings at the blade's rate. Output in m/s² when the recordings' gains are calibrated, else full scale.
///
/// Plays the nearest recorded rate; switches as soon as another is nearer by 2 %, and at a pitch change of 15 % in any
/// case if another is within that. Between two recorded loads the mix follows the load. Each switch is a cross-fade of
/// `fade_time` whose gains account for the correlation of the recordings, so that the power changes smoothly. Below
/// the lowest recorded rate the level falls with the square of the rate, as the acceleration of a stroke of
/// constant length does. Without free-air recordings, cutting ones 12 dB lower replace them; without cutting ones,
/// free-air ones replace them unchanged.
///
/// `tick` is wait-free, does not allocate, and depends on its arguments and the state only.
class SawVoice {
public:
    static constexpr double greatest_rate = 1000.0;  ///< Hz, of the blade
    static constexpr double greatest_pitch_change = 0.15;
    static constexpr std::size_t most_recordings = 32;

    /// `rate`: sample rate of the output. Throws Error when there is no recording, a value is not positive and finite,
    /// or a recording is shorter than 8 cycles. Resamples and loops each recording, which allocates.
    void prepare(double rate, std::span<const SawRecording> recordings, const SawBehaviour& behaviour = {});

    /// One sample. `load` in N (non-finite: none), `commanded_rate` in Hz, clamped to [0, greatest_rate].
    float tick(double load, bool trigger, double commanded_rate) noexcept;

    SawState state() const { return state_; }
    double reciprocation_rate() const { return blade_rate_; }  ///< Hz, at this instant
    bool running() const { return state_ != SawState::off; }  ///< the blade moves
    double phase() const { return cycles_; }  ///< cycles of the blade since the start
    /// Index in `prepare`'s list of the loudest recording now; -1 when off.
    int loudest_recording() const;

private:
    struct Layer {
        std::size_t loop;  // in loops_
        double rate, load, amplitude;
        bool cutting;
        double level = 0.0;  // rms
        double target = 0.0, weight = 0.0;  // shares in the mix
    };
    /// The layers of one recorded rate, one per load.
    struct Group {
        double rate = 0.0;
        double border = 0.0;  // square of the blade's rate above which the next group is nearer
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
    std::array<std::size_t, 2 * most_recordings> active_{};  // layers that play or are about to, in order
    std::size_t active_count_ = 0;
    SawBehaviour behaviour_;
    double rate_ = 48000.0, up_share_ = 1.0, down_share_ = 1.0, fade_step_ = 1.0, lowest_recorded_ = 1.0;
    double blade_rate_ = 0.0, cycles_ = 0.0;
    std::ptrdiff_t playing_[2] = {-1, -1};  // group in use: free air, cutting
    bool loaded_ = false;
    SawState state_ = SawState::off;
};

}  // namespace tactus::vibration
