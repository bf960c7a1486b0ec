// SPDX-License-Identifier: Apache-2.0
// Vibration of a powered saw at audio rate, synthesised from recordings that share one phase of the blade.
#pragma once

#include "dsp/vibration/blade_motion.hpp"
#include "dsp/vibration/cycle_loop.hpp"
#include "dsp/vibration/saw_recording.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tactus::vibration {

/// Plays the recordings at the blade's rate. Output in m/s² when the recordings' gains are calibrated, else full scale.
///
/// Plays the nearest recorded rate; switches as soon as another is nearer by 2 %, and at a pitch change of 15 % in any
/// case if another is within that. Between two recorded loads the mix follows the load. Each switch is a cross-fade of
/// `fade_time` whose gains account for the correlation of the recordings, so that the power changes smoothly. Below
/// the lowest recorded rate the level falls with the square of the rate, as the acceleration of a stroke of
/// constant length does; above the highest it stays, and no component is played above half of the sample rate. Without
/// free-air recordings, cutting ones 12 dB lower replace them; without cutting ones, free-air ones replace them
/// unchanged.
///
/// `tick` is wait-free, does not allocate, and depends on its arguments and the state only.
class SawVoice {
public:
    static constexpr double greatest_pitch_change = 0.15;
    static constexpr std::size_t max_recordings = 32;

    /// `rate`: sample rate of the output. Throws Error when there is no recording, a value is not positive and finite,
    /// or a recording is shorter than 8 cycles. Resamples and loops each recording, which allocates.
    void prepare(double rate, std::span<const SawRecording> recordings, const SawBehaviour& behaviour = {});

    /// One sample. `load` in N (non-finite: none), `commanded_rate` in Hz, clamped to [0, BladeMotion::greatest_rate].
    /// `contact`: the blade touches bone; without it the load decides.
    float tick(double load, bool trigger, double commanded_rate, std::optional<bool> contact = {}) noexcept;

    SawState state() const { return blade_.state(); }
    double reciprocation_rate() const { return blade_.rate(); }  ///< Hz, at this instant
    bool running() const { return blade_.state() != SawState::off; }  ///< the blade moves
    double phase() const { return blade_.cycles(); }  ///< cycles of the blade since the start
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
    void choose_layers(double load) noexcept;
    const Group& choose_group() noexcept;
    void aim(Layer& layer, double share) noexcept;
    double sample(const Layer& layer) const noexcept;
    double mix() noexcept;
    std::span<const std::size_t> active() const noexcept { return {active_.data(), active_count_}; }

    std::vector<CycleLoop> loops_;
    std::vector<Layer> layers_;
    std::vector<double> likeness_;  // loops × loops
    std::vector<Group> groups_[2];  // free air, cutting; by rate
    std::array<std::size_t, 2 * max_recordings> active_{};  // layers that play or are about to, in order
    std::size_t active_count_ = 0;
    SawBehaviour behaviour_;
    BladeMotion blade_;
    double fade_step_ = 1.0, lowest_recorded_ = 1.0;
    std::ptrdiff_t playing_[2] = {-1, -1};  // group in use: free air, cutting
};

}  // namespace tactus::vibration
