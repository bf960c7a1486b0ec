// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace tactus::nodes {

struct SlowOscillator {
    static constexpr auto about =
        "A number that swings: sine, triangle, square or ramp (low-frequency oscillator). Its phase is continuous when "
        "the "
        "frequency changes.";

    Out<double> out{"offset + amplitude × shape"};
    Param frequency{"1 Hz", "0 Hz", "1 kHz", "cycles per second"};
    Param amplitude{"1", "-1e6", "1e6", "largest distance from the offset, in SI units"};
    Param offset{"0", "-1e6", "1e6", "centre, in SI units"};
    Choice shape{{"sine", "triangle", "square", "ramp"}, "ramp rises from -1 to 1 and falls at once"};

    void prepare(const Setup&) {
        phase_ = 0.0;
        is_first_ = true;
    }
    void process(const Tick& tick) noexcept {
        if (!is_first_) phase_ += frequency * tick.elapsed_seconds();
        is_first_ = false;
        phase_ -= std::floor(phase_);
        out = offset + amplitude * at(phase_);
    }

private:
    double at(double phase) const noexcept {
        switch (shape.index) {
            case 0: return std::sin(2.0 * std::numbers::pi * phase);
            case 1: return phase < 0.25 ? 4.0 * phase : phase < 0.75 ? 2.0 - 4.0 * phase : 4.0 * phase - 4.0;
            case 2: return phase < 0.5 ? 1.0 : -1.0;
            default: return 2.0 * phase - 1.0;
        }
    }

    double phase_ = 0.0;
    bool is_first_ = true;
};

TACTUS_NODE(SlowOscillator, out, frequency, amplitude, offset, shape)

}  // namespace tactus::nodes
