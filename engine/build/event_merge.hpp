// SPDX-License-Identifier: Apache-2.0
// Merges the events of all wires into one input.
#pragma once

#include "engine/run/link.hpp"
#include "graph/node/event.hpp"
#include "graph/node/port.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::build {

/// A source of events: an output of the same group, with its delay, or a link.
struct EventFeed {
    std::string name;  ///< of the output, "node.port"
    int delay = 0;     ///< activations of the producer
    const std::byte* values = nullptr;  ///< of a source in the same group: values of the first activation of a call
    std::ptrdiff_t stride = 0;
    const run::LinkWire* link = nullptr;

    // The events of this activation that have not been delivered yet:
    const Events* list = nullptr;
    int lists = 0, at = 0;
    int used = 0;  ///< number of the link's lists used in this call

    const Event* head() const noexcept { return lists > 0 ? list->list.data() + at : nullptr; }
    void skip_finished() noexcept {
        while (lists > 0 && at >= list->count) {
            ++list;
            --lists;
            at = 0;
        }
    }
};

/// Group's thread; wait-free.
class EventMerge {
public:
    /// Large, because a fast group may emit many events between two activations of a slow group.
    static constexpr int most = 1024;

    explicit EventMerge(Input& target_) : target(&target_) {}

    Input* target;
    std::vector<EventFeed> feeds;

    /// Sorts the sources by name, so that simultaneous events have an order that does not depend on the text of the
    /// patch.
    void sort_feeds();
    /// Delivers the events that become visible at an activation of the call. Call it once per activation, in order.
    /// Returns the number of events dropped for lack of room.
    int gather(int activation) noexcept;

private:
    EventBuffer<most> merged_;
};

}  // namespace tactus::build
