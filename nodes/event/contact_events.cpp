// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::nodes {

struct ContactEvents {
    static constexpr auto about =
        "An event when a contact begins and one when it ends. Numbers of each: speed in m/s, depth in m; at the end "
        "the "
        "greatest depth there was. A depth that is not a number changes nothing.";

    In<double> depth{"of the contact, negative or 0 outside", "m"};
    In<Twist> twist{optional,
                    "of the tool: the speed of an event is its speed. Without it, that is how fast 'depth' changes in "
                    "one tick, which is too little for a depth that stays 0 outside",
                    "m/s, rad/s"};
    In<bool> contact{optional,
                     "of a tool, such as saw_blade.in_contact: begin and end are its own; unconnected: 'depth' "
                     "decides"};
    Out<Event> events{"begins and ends"};
    Out<bool> in_contact{"between a begin and an end"};
    Param begin{"0 mm", "-100 mm", "100 mm", "the contact begins beyond this depth"};
    Param hysteresis{"0 mm", "0 mm", "100 mm", "it ends when the depth has come back by this much"};

    void prepare(const Setup& setup) {
        emit_.prepare(setup);
        in_contact = false;
        is_first_ = true;
        deepest_ = last_ = 0.0;
    }
    void process(const Tick& tick) noexcept {
        const double now = depth;
        if (!std::isfinite(now)) return;
        const double change = is_first_ ? 0.0 : (now - last_) / tick.elapsed_seconds();
        is_first_ = false;
        last_ = now;
        const double speed = std::abs(twist.connected ? glm::length(twist->linear) : change);
        const bool touches = contact.connected   ? contact.get()
                             : !in_contact.get() ? now > begin
                                                 : now > begin - hysteresis;
        if (!in_contact.get() && touches) {
            in_contact = true;
            deepest_ = now;
            emit_(events, tick, 0, EventKind::begin, {speed, now});
        } else if (in_contact.get() && !touches) {
            in_contact = false;
            emit_(events, tick, 0, EventKind::end, {speed, deepest_});
        }
        deepest_ = std::max(deepest_, now);
    }

private:
    Emitter emit_;
    double last_ = 0.0, deepest_ = 0.0;
    bool is_first_ = true;
};

TACTUS_NODE(ContactEvents, depth, twist, contact, events, in_contact, begin, hysteresis)

}  // namespace tactus::nodes
