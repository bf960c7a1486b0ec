// SPDX-License-Identifier: Apache-2.0
#include "engine/link.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace tactus {

void Link::prepare(Flicks slack, int producer_frames, int consumer_frames) {
    // Slot m is wanted until the consumer's next read; latency and the lengths of calls on both sides add to that.
    const Flicks reach = consumer_period * consumer_frames + latency + slack;
    depth_ = ceil_div(reach, producer_period) + 2 + 2 * static_cast<std::int64_t>(producer_frames);
    stamp_.assign(static_cast<std::size_t>(depth_), -1);
    const auto depth = static_cast<std::size_t>(depth_);
    for (LinkWire& wire : wires) {
        const std::size_t size = wire.type->size;
        wire.ring.assign(depth * size, std::byte{0});
        wire.current.assign(wire.source->data, wire.source->data + size);
        wire.previous = wire.current;
        if (wire.mode == WireMode::linear) wire.glide.resize(size * static_cast<std::size_t>(consumer_frames));
        if (wire.mode == WireMode::batch) {
            wire.batch.resize(depth * size);
            wire.batch_times.resize(depth);
        }
        if (wire.param) wire.param->drive(*reinterpret_cast<const double*>(wire.current.data()));
        if (wire.target) {
            wire.target->data = wire.mode == WireMode::batch ? wire.batch.data() : wire.current.data();
            wire.target->times = wire.batch_times.data();
            wire.target->period = producer_period;
        }
    }
}

void Link::publish(std::int64_t first, int count) noexcept {
    for (LinkWire& wire : wires)
        for (int i = 0; i < count; ++i)
            std::memcpy(wire.slot(first + i, depth_), wire.source->data + i * wire.source->stride, wire.type->size);
    for (int i = 0; i < count; ++i) stamp_[static_cast<std::size_t>((first + i) % depth_)] = first + i;
}

std::int64_t Link::oldest_version(const Output* output) const noexcept {
    std::int64_t oldest = std::numeric_limits<std::int64_t>::max();
    const std::int64_t held = oldest_.load(std::memory_order_acquire);
    for (const LinkWire& wire : wires) {
        if (wire.source != output) continue;
        // Index −1 is the value set by prepare, which counts as the oldest there is.
        if (held < 0) return 0;
        for (std::size_t slot = 0; slot < stamp_.size(); ++slot)
            if (stamp_[slot] >= held)
                oldest = std::min(oldest, wire.type->version(wire.ring.data() + slot * wire.type->size));
    }
    return oldest;
}

std::int64_t Link::newest_available(std::int64_t want, std::int64_t done) const noexcept {
    for (std::int64_t index = std::min(want, done - 1); index > used_; --index)
        if (holds(index)) return index;
    return used_;
}

void Link::gather_batch(LinkWire& wire, std::int64_t index) noexcept {
    int count = 0;
    for (std::int64_t k = std::max(used_ + 1, index - depth_ + 1); k <= index; ++k) {
        if (!holds(k)) continue;
        std::memcpy(wire.batch.data() + static_cast<std::size_t>(count) * wire.type->size, wire.slot(k, depth_),
                    wire.type->size);
        wire.batch_times[static_cast<std::size_t>(count++)] = k * producer_period;
    }
    wire.target->count = count;
}

void Link::read(std::int64_t index) noexcept {
    fresh_ = true;
    for (LinkWire& wire : wires) {
        if (wire.mode == WireMode::batch) {
            gather_batch(wire, index);
            continue;
        }
        if (index == used_) continue;
        if (wire.mode == WireMode::linear) {
            // The value before the new one; after a gap, the one that was in use.
            const bool adjacent = index - 1 > used_ && holds(index - 1);
            std::memcpy(wire.previous.data(), adjacent ? wire.slot(index - 1, depth_) : wire.current.data(),
                        wire.type->size);
        }
        std::memcpy(wire.current.data(), wire.slot(index, depth_), wire.type->size);
    }
    used_ = index;
    oldest_.store(index, std::memory_order_release);
}

void Link::deliver(std::int64_t j, int frames) noexcept {
    for (LinkWire& wire : wires) {
        if (wire.mode == WireMode::batch) {
            // A batch is seen by one call only, however many calls share one read.
            if (!fresh_) wire.target->count = 0;
            continue;
        }
        const std::byte* values = wire.current.data();
        std::ptrdiff_t stride = 0;
        if (wire.mode == WireMode::linear) {
            for (int i = 0; i < frames; ++i) {
                const Flicks past = (j + i) * consumer_period - latency - used_ * producer_period;
                const double t = std::clamp(static_cast<double>(past) / static_cast<double>(producer_period), 0.0, 1.0);
                wire.type->interpolate(wire.previous.data(), wire.current.data(), t,
                                       wire.glide.data() + static_cast<std::size_t>(i) * wire.type->size);
            }
            values = wire.glide.data();
            stride = static_cast<std::ptrdiff_t>(wire.type->size);
        }
        if (wire.target) {
            wire.target->data = values;
            wire.target->stride = stride;
        } else if (wire.mode != WireMode::linear) {
            wire.param->drive(*reinterpret_cast<const double*>(values));
        }
    }
    fresh_ = false;
}

}  // namespace tactus
