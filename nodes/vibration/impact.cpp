// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::nodes {

struct Impact {
    static constexpr auto about =
        "The transient of a tap: a decaying sine as strong as the hand was fast, amplitude × speed × e^(-t/decay) × "
        "sin(2π frequency t) (Okamura 2001, Kuchenbecker 2006). A tap on one that still rings is added to it. It has "
        "no "
        "materials: frequency and decay are to be measured on one, or invented.";

    In<bool> hit{"a tap begins when it becomes true"};
    In<double> speed{optional, "of the hand at that time; its size counts; open: 1 m/s", "m/s"};
    Out<Signal> out{"the vibration", "m/s^2"};
    Param frequency{"150 Hz", "1 Hz", "20 kHz", "of the sine"};
    Param decay{"12 ms", "0.1 ms", "10 s", "time constant after which it has fallen to 1/e"};
    Param amplitude{"100 1/s", "0 1/s", "1e6 1/s", "acceleration per speed"};
    Param most{"500 m/s^2", "0 m/s^2", "1e6 m/s^2", "largest amplitude of one tap"};

    void prepare(const Setup& setup) {
        dt_ = seconds(setup.period);
        sine_ = cosine_ = 0.0;
        was_ = false;
    }
    void process(const Tick& tick) noexcept {
        if (hit && !was_) {
            const double v = speed.connected ? std::abs(speed.get()) : 1.0;
            if (std::isfinite(v)) cosine_ += std::min(amplitude * v, +most);
        }
        was_ = hit;
        // Above a quarter of the rate it would alias into what a hand feels.
        const double turn = 2.0 * std::numbers::pi * std::min(frequency * dt_, 0.25);
        const double keep = std::exp(-dt_ / decay), c = keep * std::cos(turn), s = keep * std::sin(turn);
        for (int i = 0; i < tick.frames; ++i) {
            out[i] = signal::to_sample(sine_);
            const double next = c * cosine_ - s * sine_;
            sine_ = s * cosine_ + c * sine_;
            cosine_ = next;
            // No tail of denormal numbers.
            if (sine_ * sine_ + cosine_ * cosine_ < 1e-24) sine_ = cosine_ = 0.0;
        }
    }

private:
    double dt_ = 0.0;
    double sine_ = 0.0, cosine_ = 0.0;  // what rings, and a quarter of a cycle ahead
    bool was_ = false;
};

TACTUS_NODE(Impact, hit, speed, out, frequency, decay, amplitude, most)

}  // namespace tactus::nodes
