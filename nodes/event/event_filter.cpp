// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

#include <cstdint>

namespace tactus::nodes {

struct EventFilter {
    static constexpr auto about =
        "Passes the events of one kind, or of one node, on; or brings the events of several wires into one.";

    In<Event> in{"the events, of any number of wires"};
    Out<Event> out{"those that pass; their time is that of the tick that gives them"};
    Text source{"", "name of the node that gave the event first; empty: any"};
    EventChoice choice;

    void prepare(const Setup&) { wanted_ = event_source(source.value); }
    void process(const Tick& tick) noexcept {
        out.get().lose(in.lost());
        const bool takes_all = source.value.empty();
        for (Event event : in.events()) {
            if (!choice.takes(event) || (!takes_all && event.source != wanted_)) continue;
            event.time = time_at(tick);
            out.get().add(event);
        }
    }

private:
    std::uint32_t wanted_ = 0;
};

TACTUS_NODE(EventFilter, in, out, source, choice)

}  // namespace tactus::nodes
