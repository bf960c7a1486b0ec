// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

namespace tactus::nodes {

struct EventCounter {
    static constexpr auto about = "Counts events, all of a tick at once.";

    In<Event> in{"the events, of any number of wires"};
    In<bool> reset{optional, "true: both counts are 0, that of this tick's events, too"};
    Out<double> count{"how many have come"};
    Out<double> lost{"how many more there were, of every kind: a wire brings at most 16 of one tick"};
    EventChoice choice;

    void prepare(const Setup&) {
        count = 0.0;
        lost = 0.0;
    }
    void process(const Tick&) noexcept {
        double now = count.get();
        for (const Event& event : in.events()) now += choice.takes(event) ? 1.0 : 0.0;
        count = reset ? 0.0 : now;
        lost = reset ? 0.0 : lost.get() + in.lost();
    }
};

TACTUS_NODE(EventCounter, in, reset, count, lost, choice)

}  // namespace tactus::nodes
