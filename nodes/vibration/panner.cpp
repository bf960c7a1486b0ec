// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/sample.hpp"
#include "graph/node/node.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::nodes {

struct Panner {
    static constexpr auto about =
        "Shares a signal between two actuators, so that it is felt between them: a phantom sensation (von Békésy 1959; "
        "laws: Israr and Poupyrev 2011, Tactile Brush).";

    In<Signal> in{"the signal"};
    In<tactus::Ramp> place{optional, "instead of `position`"};
    Out<Signal> left{"for the actuator at 0"};
    Out<Signal> right{"for the actuator at 1"};
    Param position{"0.5", "0", "1", "where it is felt: 0 at the left actuator, 1 at the right one"};
    Choice law{{"energy", "linear"},
               "energy: the squares of both gains add up to 1, equally strong everywhere; linear: the gains do"};

    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) {
            const double wanted = place.connected ? static_cast<double>(place[i]) : position.value;
            const double at = wanted == wanted ? std::clamp(wanted, 0.0, 1.0) : 0.5;
            const double x = signal::finite_or_zero(in[i]);
            left[i] = signal::to_sample(x * (law.index == 0 ? std::sqrt(1.0 - at) : 1.0 - at));
            right[i] = signal::to_sample(x * (law.index == 0 ? std::sqrt(at) : at));
        }
    }
};

TACTUS_NODE(Panner, in, place, left, right, position, law)

}  // namespace tactus::nodes
