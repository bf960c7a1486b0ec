// SPDX-License-Identifier: Apache-2.0
// How a link carries events: those for which there is no room are counted, and ends come later.
#include "engine/run/link.hpp"

#include <cstdint>

namespace tactus::run {

namespace {

const Events& events_at(const Output& output, int activation) noexcept {
    return *reinterpret_cast<const Events*>(output.data + activation * output.stride);
}

}  // namespace

std::int64_t Link::publish_events(LinkWire& wire, std::int64_t first, int count) noexcept {
    std::int64_t lost = 0;
    for (int i = 0; i < count; ++i) {
        const Events& given = events_at(*wire.source, i);
        Events& slot = *reinterpret_cast<Events*>(wire.slot(first + i, depth_));
        if (wire.carried->is_empty()) {
            copy_events(given, slot);
            continue;
        }
        const std::int64_t known = std::int64_t{wire.carried->lost} + given.lost;
        wire.carried->add_all(given);
        lost += wire.carried->lost - known;
        copy_events(*wire.carried, slot);
        wire.carried->clear();
    }
    return lost;
}

std::int64_t Link::drop(int count) noexcept {
    std::int64_t lost = 0;
    for (LinkWire& wire : wires) {
        if (!wire.brings_events()) continue;
        for (int i = 0; i < count; ++i) {
            const Events& given = events_at(*wire.source, i);
            wire.carried->lose(given.lost);
            const std::int64_t known = wire.carried->lost;
            for (const Event& event : given.all())
                if (event.kind == EventKind::end) wire.carried->add(event);
                else wire.carried->lose(1);
            lost += wire.carried->lost - known;
        }
    }
    return lost;
}

void Link::begin_at(std::int64_t index) noexcept {
    for (LinkWire& wire : wires)
        if (wire.brings_events() && wire.before) copy_events(*wire.before->carried, *wire.carried);
    first_.store(index, std::memory_order_release);
}

}  // namespace tactus::run
