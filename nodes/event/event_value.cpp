// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

#include <cmath>
#include <cstddef>

namespace tactus::nodes {

struct EventValue {
    static constexpr auto about = "Keeps a number of the last event, such as the speed of the last contact. SI units.";

    In<Event> in{"the events, of any number of wires"};
    Out<double> value{"the number; 'initial' until an event has brought one that is finite"};
    Out<double> age{"since the tick that gave the last event; 0 before the first", "s"};
    Param place{structural, "0", "0", "3", "which number of the event, from 0"};
    Param initial{"0", "-1e12", "1e12", "the value before the first event"};
    EventChoice choice;

    void prepare(const Setup&) {
        has_value_ = has_event_ = false;
        value = initial;
        age = 0.0;
    }
    void process(const Tick& tick) noexcept {
        const auto at = static_cast<std::size_t>(place);
        if (!has_value_) value = initial;
        for (const Event& event : in.events()) {
            if (!choice.takes(event)) continue;
            has_event_ = true;
            last_ = event.time;
            if (at >= event.count || !std::isfinite(event.values[at])) continue;
            has_value_ = true;
            value = event.values[at];
        }
        age = has_event_ ? seconds(time_at(tick) - last_) : 0.0;
    }

private:
    Flicks last_ = 0;
    bool has_value_ = false, has_event_ = false;
};

TACTUS_NODE(EventValue, in, value, age, place, initial, choice)

}  // namespace tactus::nodes
