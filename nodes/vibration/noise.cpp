// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/random.hpp"
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

#include <cstdint>
#include <numbers>

namespace tactus::nodes {

struct Noise {
    static constexpr auto about =
        "White or pink noise. The same patch gives the same noise; 'seed' gives another. White noise has the same "
        "power in "
        "each hertz, pink noise the same in each octave (within 0.1 dB from 1/5000 of the rate to a third of it).";

    Out<Signal> signal{"the noise, with the root mean square 'level'"};
    Param level{"0.1", "0", "1e6", "root mean square"};
    Choice colour{{"white", "pink"}, "white: flat; pink: -3 dB per octave"};
    Param seed{structural, "0", "0", "1e9", "another seed gives another noise"};

    void prepare(const Setup& setup) {
        state_ = mix(setup.seed ^ mix(static_cast<std::uint64_t>(seed)));
        for (Section& section : sections_) section.y = 0.0;
    }
    void process(const Tick& tick) noexcept {
        const double a = level;
        std::uint64_t state = state_;
        if (colour.index == 0) {
            for (int i = 0; i < tick.frames; ++i) signal[i] = static_cast<float>(a * white(state));
        } else {
            for (int i = 0; i < tick.frames; ++i) signal[i] = signal::to_sample(a * pink(white(state)));
        }
        state_ = state;
    }

private:
    struct Section {
        double pole, gain, y;
    };

    /// Uniform, with variance 1: the upper half of a congruential generator of 64 bits (Knuth's MMIX), as signed.
    static double white(std::uint64_t& state) noexcept {
        state = state * 6364136223846793005u + 1442695040888963407u;
        return (static_cast<double>(static_cast<std::int32_t>(state >> 32)) + 0.5) * (std::numbers::sqrt3 * 0x1.0p-31);
    }

    double pink(double white) noexcept {
        double sum = direct_ * white;
        for (Section& s : sections_) {
            s.y = s.pole * s.y + s.gain * white;
            sum += s.y;
        }
        return sum;
    }

    std::uint64_t state_ = 0;
    // First-order sections fitted to 1/√f by least squares in decibels, for unit variance.
    static constexpr double direct_ = -0.0197881805;
    Section sections_[6] = {{0.999337664, 0.0132622611, 0.0}, {0.996379613, 0.016606242, 0.0},
                            {0.984686884, 0.0322247567, 0.0}, {0.937277154, 0.0648630477, 0.0},
                            {0.760642851, 0.129550216, 0.0},  {0.272984484, 0.293951995, 0.0}};
};

TACTUS_NODE(Noise, signal, level, colour, seed)

}  // namespace tactus::nodes
