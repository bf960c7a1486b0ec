// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactus::nodes {

struct EventDelay {
    static constexpr auto about =
        "Gives each event again after a time, at the first tick at which that has passed. 256 may wait; when there is "
        "no room, ends survive.";

    In<Event> in{"the events, of any number of wires"};
    Out<Event> out{"the same events, later; their time is that of the tick that gives them"};
    Param delay{"100 ms", "0 s", "1 h", "for how long"};

    void prepare(const Setup&) { count_ = 0; }
    void process(const Tick& tick) noexcept {
        const Flicks now = time_at(tick);
        out.get().lose(in.lost());
        const auto after = static_cast<Flicks>(std::llround(delay * static_cast<double>(flicks_per_second)));
        for (Event event : in.events()) {
            event.time = now + after;
            keep(event);
        }
        std::size_t given = 0;
        // What a tick has no room for comes in the next.
        for (; given < count_ && waiting_[given].time <= now && out.get().count < Events::room; ++given) {
            Event event = waiting_[given];
            event.time = now;
            out.get().add(event);
        }
        std::copy(waiting_.data() + given, waiting_.data() + count_, waiting_.data());
        count_ -= given;
    }

private:
    /// By the time it is due, behind those of that time.
    void keep(const Event& event) noexcept {
        if (count_ == waiting_.size()) {
            out.get().lose(1);
            if (event.kind != EventKind::end) return;
            std::size_t at = count_;
            while (at > 0 && waiting_[at - 1].kind == EventKind::end) --at;
            if (at == 0) return;
            std::copy(waiting_.data() + at, waiting_.data() + waiting_.size(), waiting_.data() + at - 1);
            --count_;
        }
        std::size_t at = count_++;
        for (; at > 0 && waiting_[at - 1].time > event.time; --at) waiting_[at] = waiting_[at - 1];
        waiting_[at] = event;
    }

    std::array<Event, 256> waiting_{};
    std::size_t count_ = 0;
};

TACTUS_NODE(EventDelay, in, out, delay)

}  // namespace tactus::nodes
