// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/fast_sine.hpp"
#include "graph/node/node.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tactus::nodes {

struct ForceTone {
    static constexpr auto about =
        "Makes a force audible for a hand that no device pushes: the larger the force, the louder and higher the tone. "
        "Without a force it is silent.";

    In<Wrench> wrench{"the force to hear"};
    Out<Signal> signal{"the tone; full scale is 1"};
    Param full_force{"10 N", "0.1 N", "1000 N", "force of the loudest and highest tone"};
    Param lowest{"110 Hz", "20 Hz", "10 kHz", "frequency of the smallest force"};
    Param highest{"440 Hz", "20 Hz", "10 kHz", "frequency of the full force"};
    Param level{"0.5", "0", "1", "amplitude at the full force"};

    void prepare(const Setup& setup) {
        rate_ = setup.rate();
        // A force changes in steps of its own rate, which would be heard.
        constexpr double smoothing_s = 5e-3;
        share_ = 1.0 - std::exp(-1.0 / (smoothing_s * rate_));
        now_ = 0.0;
        wave_ = {};
    }
    void process(const Tick& tick) noexcept {
        const double force = glm::length(wrench->force);
        const double wanted = std::isfinite(force) ? std::min(force / full_force, 1.0) : 0.0;
        const double octaves = std::log2(highest / lowest);
        for (int i = 0; i < tick.frames; ++i) {
            now_ += share_ * (wanted - now_);
            const double frequency = std::min(lowest * std::exp2(octaves * now_), 0.25 * rate_);
            wave_.phase += signal::WavePhase::step(frequency / rate_);
            signal[i] =
                static_cast<float>(level * now_) * signal::fast_sine(static_cast<std::int32_t>(wave_.phase >> 32));
        }
    }

private:
    double rate_ = 48000.0, share_ = 1.0, now_ = 0.0;
    signal::WavePhase wave_;
};

TACTUS_NODE(ForceTone, wrench, signal, full_force, lowest, highest, level)

}  // namespace tactus::nodes
