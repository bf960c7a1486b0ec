// SPDX-License-Identifier: Apache-2.0
#include "engine/build/event_merge.hpp"

#include <algorithm>
#include <tuple>

namespace tactus::build {

void EventMerge::sort_feeds() {
    std::ranges::sort(feeds, [](const EventFeed& a, const EventFeed& b) {
        return std::tie(a.name, a.delay) < std::tie(b.name, b.delay);
    });
}

int EventMerge::gather(int activation) noexcept {
    merged_.clear();
    for (EventFeed& feed : feeds) {
        feed.at = 0;
        if (feed.link) {
            if (activation == 0) feed.used = 0;
            feed.list = reinterpret_cast<const Events*>(feed.link->batch.data()) + feed.used;
            feed.lists = feed.link->batch_counts[static_cast<std::size_t>(activation)];
            feed.used += feed.lists;
        } else {
            feed.list = reinterpret_cast<const Events*>(feed.values + activation * feed.stride);
            feed.lists = 1;
        }
        for (int i = 0; i < feed.lists; ++i) merged_.lose(feed.list[i].lost);
        feed.skip_finished();
    }
    const int lost_before = merged_.lost;
    for (;;) {
        EventFeed* first = nullptr;
        for (EventFeed& feed : feeds)
            if (feed.head() && (!first || feed.head()->time < first->head()->time)) first = &feed;
        if (!first) break;
        merged_.add(*first->head());
        ++first->at;
        first->skip_finished();
    }
    target->data = reinterpret_cast<const std::byte*>(static_cast<const EventList*>(&merged_));
    return merged_.lost - lost_before;
}

}  // namespace tactus::build
