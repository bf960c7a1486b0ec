// SPDX-License-Identifier: Apache-2.0
// Code common to nodes that emit and receive events.
#pragma once

#include "graph/node/event.hpp"
#include "graph/node/node.hpp"

#include <cstdint>
#include <initializer_list>

namespace tactus::nodes {

/// Time of the i-th activation of a call.
inline Flicks time_at(const Tick& tick, int i = 0) noexcept { return (tick.index + i) * tick.period; }

/// Emits events with the name of its node.
class Emitter {
public:
    void prepare(const Setup& setup) { source_ = event_source(setup.name); }
    void operator()(Out<Event>& out, const Tick& tick, int i, EventKind kind,
                    std::initializer_list<double> values) const noexcept {
        out[i].add(make_event(time_at(tick, i), source_, kind, values));
    }

private:
    std::uint32_t source_ = 0;
};

/// Selection of the kinds of events to use.
struct EventChoice {
    Choice on{{"any", "begin", "end", "instant"}, "which events count: all, or those of one kind"};
    TACTUS_GROUP(on)

    bool takes(const Event& event) const noexcept {
        switch (on.index) {
            case 1: return event.kind == EventKind::begin;
            case 2: return event.kind == EventKind::end;
            case 3: return event.kind == EventKind::instant;
            default: return true;
        }
    }
};

}  // namespace tactus::nodes
