// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

#include <algorithm>

namespace tactus::nodes {

struct EventTrigger {
    static constexpr auto about =
        "Turns events into bools, for all nodes that a bool triggers: counter, sequencer, sample_and_hold, adsr.";

    In<Event> in{"the events, of any number of wires"};
    Out<bool> trigger{
        "true for one tick at each event that counts. When one comes right after another, or two at once, false for a "
        "tick stands between them, so that each one is seen; up to 16 are queued"};
    Out<bool> gate{"true from a begin to an end, regardless of 'on'"};
    EventChoice choice;

    void prepare(const Setup&) {
        trigger = false;
        gate = false;
        waiting_ = 0;
    }
    void process(const Tick&) noexcept {
        for (const Event& event : in.events()) {
            if (event.kind != EventKind::instant) gate = event.kind == EventKind::begin;
            if (choice.takes(event)) waiting_ = std::min(waiting_ + 1, 16);
        }
        trigger = waiting_ > 0 && !trigger.get();
        waiting_ -= trigger.get();
    }

private:
    int waiting_ = 0;
};

TACTUS_NODE(EventTrigger, in, trigger, gate, choice)

}  // namespace tactus::nodes
