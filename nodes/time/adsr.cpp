// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/one_pole.hpp"
#include "graph/node/node.hpp"

#include <algorithm>

namespace tactus::nodes {

struct Adsr {
    static constexpr auto about =
        "Attack, decay, sustain, release: a level that rises to 1 while a gate is open, falls to the sustain level, "
        "and to "
        "0 when the gate closes. Attack is a straight line; decay and release approach their end exponentially and are "
        "within 1 % of it after the time given.";

    In<bool> gate{"true: a note is held"};
    Out<double> level{"from 0 to 1"};
    Param attack{"5 ms", "0 s", "1 min", "from 0 to 1"};
    Param decay{"50 ms", "0 s", "1 min", "from 1 to the sustain level"};
    Param sustain{"0.7", "0", "1", "level while the gate stays open"};
    Param release{"100 ms", "0 s", "1 min", "from the level to 0"};

    void prepare(const Setup&) {
        level = 0.0;
        rises_ = was_ = false;
    }
    void process(const Tick& tick) noexcept {
        const double dt = tick.elapsed_seconds();
        double now = level.get();
        if (gate && !was_) rises_ = true;
        was_ = gate;
        if (!gate) rises_ = false;
        if (rises_) {
            now = attack > 0.0 ? std::min(now + dt / attack, 1.0) : 1.0;
            rises_ = now < 1.0;
        } else {
            const double goal = gate ? sustain.value : 0.0, time = gate ? decay : release;
            now += signal::lag_share(time / time_constants, dt) * (goal - now);
            if (!gate && now < 1e-6) now = 0.0;
        }
        level = now;
    }

private:
    static constexpr double time_constants = 4.605170185988092;  // ln 100: within 1 %
    bool rises_ = false, was_ = false;
};

TACTUS_NODE(Adsr, gate, level, attack, decay, sustain, release)

}  // namespace tactus::nodes
