// SPDX-License-Identifier: Apache-2.0
// Events: occurrences at one time, such as the start of a contact. A wire carries the events of each activation.
#pragma once

#include "dsp/core/time.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>
#include <string_view>

namespace tactus {

enum class EventKind : std::uint8_t {
    instant,  ///< happens once: an onset
    begin,  ///< start of a state that lasts: a contact, a press
    end,
};

/// One event. Its numbers are in SI units; the node that emits it documents their meaning.
struct Event {
    static constexpr std::size_t max_values = 4;

    Flicks time = 0;           ///< of the activation that emitted it
    std::uint32_t source = 0;  ///< `event_source` of the node that first emitted it
    EventKind kind = EventKind::instant;
    std::uint8_t count = 0;  ///< of `values`
    std::uint16_t unused = 0;
    std::array<double, max_values> values{};

    bool operator==(const Event&) const = default;
};
static_assert(sizeof(Event) == 16 + 32, "there are no bytes that a hash would have to leave out");

/// Identifier of a node, from its name, for Event::source.
std::uint32_t event_source(std::string_view node);

/// An event with at most four numbers. Every NaN is replaced by one bit pattern, because the bits of a NaN can depend
/// on the instructions that produced it.
inline Event make_event(Flicks time, std::uint32_t source, EventKind kind, std::initializer_list<double> values) {
    Event event{time, source, kind, 0, 0, {}};
    for (const double v : values)
        if (event.count < Event::max_values)
            event.values[event.count++] = v == v ? v : std::numeric_limits<double>::quiet_NaN();
    return event;
}

/// Header of a list of events, independent of its capacity. The events follow it in memory.
struct EventList {
    std::int32_t count = 0;
    std::int32_t lost = 0;  ///< number of events dropped for lack of room

    const Event* events() const noexcept { return reinterpret_cast<const Event*>(this + 1); }
    bool is_empty() const noexcept { return count == 0 && lost == 0; }
    void lose(std::int64_t more) noexcept {
        lost = static_cast<std::int32_t>(std::min<std::int64_t>(lost + more, std::numeric_limits<std::int32_t>::max()));
    }
};

/// Up to `most` events, in order. When the list is full, `end` events are kept: a node that waits for one would
/// otherwise wait for ever.
template <int most>
struct EventBuffer : EventList {
    static constexpr int room = most;
    std::array<Event, static_cast<std::size_t>(most)> list{};

    void clear() noexcept { count = lost = 0; }
    std::span<const Event> all() const noexcept { return {list.data(), static_cast<std::size_t>(count)}; }

    /// Adds an event. When the list is full, an `end` event replaces the newest event of another kind; any other event
    /// is dropped.
    void add(const Event& event) noexcept {
        if (count < most) {
            list[static_cast<std::size_t>(count++)] = event;
            return;
        }
        lose(1);
        if (event.kind != EventKind::end) return;
        int at = most - 1;
        while (at >= 0 && list[static_cast<std::size_t>(at)].kind == EventKind::end) --at;
        if (at < 0) return;
        std::copy(list.begin() + at + 1, list.end(), list.begin() + at);
        list.back() = event;
    }
    /// Adds the events of another list, and its count of dropped events.
    void add_all(const EventList& other) noexcept {
        lose(other.lost);
        for (int i = 0; i < other.count; ++i) add(other.events()[i]);
    }
};

/// The events of one activation, as a wire carries them.
struct Events : EventBuffer<16> {};
static_assert(sizeof(Events) == sizeof(EventList) + 16 * sizeof(Event), "the events lie right behind the head");

/// Copies the header and the used events only.
inline void copy_events(const Events& from, Events& to) noexcept {
    to.count = from.count;
    to.lost = from.lost;
    std::copy_n(from.list.begin(), from.count, to.list.begin());
}

}  // namespace tactus
