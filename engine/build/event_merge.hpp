// SPDX-License-Identifier: Apache-2.0
// The events of all wires into one input, brought together.
#pragma once

#include "engine/run/link.hpp"
#include "graph/node/event.hpp"
#include "graph/node/port.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::build {

/// Where events come from: an output of the same group, with its delay, or a link.
struct EventFeed {
    std::string name;  ///< of the output, "node.port"
    int delay = 0;     ///< activations of the producer
    const std::byte* values = nullptr;  ///< of the same group: those of the first activation of a call
    std::ptrdiff_t stride = 0;
    const run::LinkWire* link = nullptr;

    // What has not been taken yet of this activation:
    const Events* list = nullptr;
    int lists = 0, at = 0;
    int used = 0;  ///< of the link's lists in this call

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
    /// Between two activations of a slow group a fast one may give many.
    static constexpr int most = 1024;

    explicit EventMerge(Input& target_) : target(&target_) {}

    Input* target;
    std::vector<EventFeed> feeds;

    /// Those of two wires at one time come in the order of these names, whatever the text's order.
    void sort_feeds();
    /// Hands the input what becomes visible at an activation of the call. Once for each, in order. Returns how many
    /// events found no room.
    int gather(int activation) noexcept;

private:
    EventBuffer<most> merged_;
};

}  // namespace tactus::build
