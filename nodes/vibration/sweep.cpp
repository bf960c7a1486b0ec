// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/sweep.hpp"

#include "graph/node/node.hpp"

#include <cmath>

namespace tactus::nodes {

struct Sweep {
    static constexpr auto about = "A logarithmic sine sweep: each octave takes the same time.";

    Out<Signal> signal{"the sweep, then silence"};
    Param first{structural, "20 Hz", "0.1 Hz", "100 kHz", "start frequency"};
    Param last{structural, "2 kHz", "0.1 Hz", "100 kHz", "end frequency; above 'first'"};
    Param duration{structural, "8 s", "10 ms", "1000 s", "of one sweep"};
    Param pause{structural, "1 s", "0 s", "1000 s", "silence after each sweep"};
    Param repeats{structural, "1", "1", "1000", "number of sweeps"};
    Param amplitude{structural, "1", "-1e6", "1e6", "peak value"};

    void prepare(const Setup& setup) {
        if (!(last > first)) setup.fail("'last' must be above 'first'");
        if (!(last < 0.5 * setup.rate())) setup.fail("'last' must be below half the node's rate");
        sweep_ = {first, last, duration, std::min(0.02, 0.1 * duration)};
        period_ = std::llround((duration + pause) * setup.rate());
        count_ = period_ * std::llround(repeats);
        dt_ = 1.0 / setup.rate();
    }

    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) {
            const std::int64_t k = tick.index + i;
            const double value = k < count_ ? amplitude * sweep_(static_cast<double>(k % period_) * dt_) : 0.0;
            signal[i] = static_cast<float>(value);
        }
    }

private:
    vibration::ExponentialSweep sweep_;
    std::int64_t period_ = 1, count_ = 0;
    double dt_ = 0.0;
};

TACTUS_NODE(Sweep, signal, first, last, duration, pause, repeats, amplitude)

}  // namespace tactus::nodes
