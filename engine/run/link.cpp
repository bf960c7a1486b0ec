// SPDX-License-Identifier: Apache-2.0
#include "engine/run/link.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace tactus::run {

void Link::prepare(Flicks slack, CallLengths live, CallLengths here, std::int64_t first) {
    first_.store(first);
    settled_.store(continued == nullptr);
    // Slot m is in use until the consumer's next read; latency and the lengths of calls on both sides add to that.
    const auto needed = [&](const CallLengths& calls) {
        const Flicks reach = consumer_period * calls.consumer + latency + slack;
        return ceil_div(reach, producer_period) + 2 + 2 * static_cast<std::int64_t>(calls.producer);
    };
    depth_ = ceil_div(needed(here), needed(live)) * needed(live);
    // Two groups whose calls begin together may read up to where the call before ended. Where they do not, or the
    // latency is shorter, half of it is left to the producer.
    const bool is_in_step = here.producer * producer_period == here.consumer * consumer_period &&
                            latency >= here.consumer * consumer_period;
    longest_call_ = is_in_step ? here.consumer : std::max<std::int64_t>(1, latency / (2 * consumer_period));
    const auto depth = static_cast<std::size_t>(depth_);
    stamp_ = std::vector<std::atomic<std::int64_t>>(depth);
    for (auto& stamp : stamp_) stamp.store(-1, std::memory_order_relaxed);
    for (LinkWire& wire : wires) {
        const std::size_t size = wire.type->size;
        wire.ring.assign(depth * size, std::byte{0});
        wire.current.resize(size);
        if (wire.starts_from_output) std::memcpy(wire.current.data(), wire.source->data, size);
        else wire.type->make_default(wire.current.data());
        wire.previous = wire.current;
        const auto frames = static_cast<std::size_t>(here.consumer);
        const bool is_batch = wire.mode == patch::WireMode::batch;
        if (wire.mode == patch::WireMode::linear || (changes_within_calls && !is_batch))
            wire.glide.resize(size * frames);
        if (wire.type == &value::event) wire.carried = std::make_unique<Events>();
        if (is_batch) {
            held_.resize(depth + (continued ? continued->stamp_.size() : 0));
            // Values that the first part of a call released may be overwritten before the last part reads.
            const std::size_t most = changes_within_calls ? 2 * held_.size() : held_.size();
            wire.batch.resize(most * size);
            wire.batch_times.resize(most);
            if (changes_within_calls || wire.brings_events()) wire.batch_counts.resize(frames);
        }
        if (wire.param) wire.param->drive(*reinterpret_cast<const double*>(wire.current.data()));
        if (wire.target) wire.point(*wire.target, producer_period);
    }
}

void LinkWire::point(Input& input, Flicks producer_period) const {
    if (brings_events()) return;  // EventMerge does
    input.data = mode == patch::WireMode::batch ? batch.data() : current.data();
    input.times = batch_times.data();
    input.period = producer_period;
}

std::int64_t Link::publish(std::int64_t first, int count) noexcept {
    std::int64_t lost = 0;
    for (LinkWire& wire : wires) {
        if (wire.brings_events()) {
            lost += publish_events(wire, first, count);
            continue;
        }
        for (int i = 0; i < count; ++i)
            std::memcpy(wire.slot(first + i, depth_), wire.source->data + i * wire.source->stride, wire.type->size);
    }
    for (int i = 0; i < count; ++i) stamp(first + i).store(first + i, std::memory_order_relaxed);
    note_unusable(first, count);
    return lost;
}

void Link::note_unusable(std::int64_t first, int count) noexcept {
    const std::uint64_t watched = watched_.load(std::memory_order_relaxed);
    if (watched == 0) return;
    std::uint64_t unusable = 0;
    for (std::size_t w = 0; w < wires.size(); ++w) {
        const LinkWire& wire = wires[w];
        if (!wire.target || (watched & bit_of(w)) == 0) continue;
        for (int i = 0; i < count; ++i)
            if (!is_finite_value(*wire.type, wire.source->data + i * wire.source->stride)) unusable |= bit_of(w);
    }
    // The consumer may read such a value until its latency and one of its calls are over.
    if (unusable != 0) {
        last_unusable_ = unusable;
        unusable_until_ = first + count + ceil_div(latency + longest_call_ * consumer_period, producer_period);
    }
    unusable_.store(first < unusable_until_ ? last_unusable_ | unusable : unusable, std::memory_order_relaxed);
}

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

void Link::take_over() noexcept {
    if (!continued) return;
    continues_ = true;
    used_ = continued->used_;
    fresh_ = continued->fresh_;
    for (LinkWire& wire : wires) {
        if (!wire.before) continue;
        std::memcpy(wire.current.data(), wire.before->current.data(), wire.type->size);
        std::memcpy(wire.previous.data(), wire.before->previous.data(), wire.type->size);
    }
}

void Link::abandon() noexcept { hold_from(std::numeric_limits<std::int64_t>::max() / 2); }

void Link::hold_from(std::int64_t index) noexcept {
    oldest_.store(index, std::memory_order_release);
    if (settled_.load(std::memory_order_relaxed)) return;
    if (index < first_.load(std::memory_order_acquire)) {
        continued->hold_from(index);
        return;
    }
    continued->abandon();
    continues_ = false;
    settled_.store(true, std::memory_order_release);
}

bool Link::holds(std::int64_t index) const noexcept {
    if (index < 0) return false;
    if (index < first_.load(std::memory_order_acquire)) return continues_ && continued->holds(index);
    return stamp(index).load(std::memory_order_relaxed) == index;
}

const std::byte* Link::value(const LinkWire& wire, std::int64_t index) const noexcept {
    if (index >= first_.load(std::memory_order_acquire))
        return wire.ring.data() + static_cast<std::size_t>(index % depth_) * wire.type->size;
    // A new wire has no values yet.
    return continues_ && wire.before ? continued->value(*wire.before, index) : wire.current.data();
}

bool Link::may_hold(const Output* output) const noexcept {
    return std::ranges::any_of(wires, [output](const LinkWire& wire) { return wire.source == output; }) ||
           (continued && continued->may_hold(output));
}

std::int64_t Link::oldest_version(const Output* output) const noexcept {
    std::int64_t oldest = std::numeric_limits<std::int64_t>::max();
    if (!settled_.load(std::memory_order_acquire)) oldest = continued->oldest_version(output);
    const std::int64_t held = oldest_.load(std::memory_order_acquire);
    const bool is_begun = held >= first_.load(std::memory_order_relaxed);
    for (const LinkWire& wire : wires) {
        if (wire.source != output) continue;
        // Index −1 is the value set by prepare, which counts as the oldest there is.
        if (!is_begun && !wire.before && wire.starts_from_output) return 0;
        for (std::size_t slot = 0; slot < stamp_.size(); ++slot)
            if (stamp_[slot].load(std::memory_order_relaxed) >= held)
                oldest = std::min(oldest, wire.type->version(wire.ring.data() + slot * wire.type->size));
    }
    return oldest;
}

std::int64_t Link::newest_held(std::int64_t newest) const noexcept {
    if (holds(newest)) return newest;
    // When one side stood still, the kept values may be in any slot.
    std::int64_t found = -1;
    for (const auto& slot : stamp_)
        if (const std::int64_t index = slot.load(std::memory_order_relaxed); index <= newest)
            found = std::max(found, index);
    return found < 0 && continues_ ? continued->newest_held(newest) : found;
}

std::int64_t Link::newest_available(std::int64_t want, std::int64_t done) const noexcept {
    return std::max(used_, newest_held(std::min(want, done - 1)));
}

void Link::list_held(std::int64_t newest) noexcept {
    held_count_ = 0;
    const auto add = [this](std::int64_t index) { held_[held_count_++] = index; };
    if (newest - used_ <= depth_) {
        for (std::int64_t index = used_ + 1; index <= newest; ++index)
            if (holds(index)) add(index);
        return;
    }
    // When one side stood still, the kept values may be in any slot.
    const std::int64_t first = first_.load(std::memory_order_acquire);
    const auto add_all = [&](const Link& link, std::int64_t from, std::int64_t to) {
        for (const auto& slot : link.stamp_)
            if (const std::int64_t index = slot.load(std::memory_order_relaxed); index >= from && index <= to)
                add(index);
    };
    add_all(*this, std::max(used_ + 1, first), newest);
    if (continues_) add_all(*continued, used_ + 1, std::min(newest, first - 1));
    std::sort(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(held_count_));
}

void Link::gather_batch(LinkWire& wire) noexcept {
    for (std::size_t n = 0; n < held_count_; ++n) {
        const std::int64_t index = held_[n];
        if (index < first_.load(std::memory_order_acquire) && !wire.before) continue;
        if (wire.brings_events()) {
            const Events& given = *reinterpret_cast<const Events*>(value(wire, index));
            if (given.is_empty()) continue;
            copy_events(given, reinterpret_cast<Events*>(wire.batch.data())[wire.batch_count++]);
            continue;
        }
        std::memcpy(wire.batch.data() + static_cast<std::size_t>(wire.batch_count) * wire.type->size,
                    value(wire, index), wire.type->size);
        wire.batch_times[static_cast<std::size_t>(wire.batch_count++)] = index * producer_period;
    }
}

void Link::take_values(std::int64_t index) noexcept {
    if (!held_.empty()) list_held(index);
    for (LinkWire& wire : wires) {
        if (wire.mode == patch::WireMode::batch) {
            gather_batch(wire);
            continue;
        }
        if (index == used_) continue;
        if (wire.mode == patch::WireMode::linear) {
            // The value before the new one; after a gap, the one that was in use.
            const bool adjacent = index - 1 > used_ && holds(index - 1);
            std::memcpy(wire.previous.data(), adjacent ? value(wire, index - 1) : wire.current.data(), wire.type->size);
        }
        const std::byte* now = value(wire, index);
        if (now != wire.current.data()) std::memcpy(wire.current.data(), now, wire.type->size);
    }
    used_ = index;
}

void Link::read(std::int64_t index) noexcept {
    fresh_ = true;
    for (LinkWire& wire : wires) wire.batch_count = 0;
    take_values(index);
    hold_from(index);
}

void Link::interpolate(LinkWire& wire, std::int64_t j, int from, int frames) const noexcept {
    for (int i = 0; i < frames; ++i) {
        const Flicks past = (j + i) * consumer_period - latency - used_ * producer_period;
        const double t = std::clamp(static_cast<double>(past) / static_cast<double>(producer_period), 0.0, 1.0);
        wire.type->interpolate(wire.previous.data(), wire.current.data(), t,
                               wire.glide.data() + static_cast<std::size_t>(from + i) * wire.type->size);
    }
}

void Link::deliver(std::int64_t j, int frames) noexcept {
    for (LinkWire& wire : wires) {
        if (wire.mode == patch::WireMode::batch) {
            if (wire.brings_events()) {
                std::ranges::fill(wire.batch_counts, 0);
                wire.batch_counts.front() = fresh_ ? wire.batch_count : 0;
                continue;
            }
            // A batch is seen by one call only, however many calls share one read.
            wire.target->count = fresh_ ? wire.batch_count : 0;
            continue;
        }
        const std::byte* values = wire.current.data();
        std::ptrdiff_t stride = 0;
        if (wire.mode == patch::WireMode::linear) {
            interpolate(wire, j, 0, frames);
            values = wire.glide.data();
            stride = static_cast<std::ptrdiff_t>(wire.type->size);
        }
        if (wire.target) {
            wire.target->data = values;
            wire.target->stride = stride;
        } else if (wire.mode != patch::WireMode::linear) {
            wire.param->drive(*reinterpret_cast<const double*>(values));
        }
    }
    fresh_ = false;
}

void Link::deliver_part(std::int64_t index, std::int64_t j, int from, int frames) noexcept {
    for (LinkWire& wire : wires) {
        if (wire.mode != patch::WireMode::batch) continue;
        if (from == 0) {
            wire.batch_count = 0;
            std::ranges::fill(wire.batch_counts, 0);
        }
        wire.batch_counts[static_cast<std::size_t>(from)] = -wire.batch_count;
    }
    take_values(index);
    // Values of the first part may be snapshots, which nodes look into until the call ends.
    if (from == 0) hold_from(index);
    for (LinkWire& wire : wires) {
        if (wire.mode == patch::WireMode::batch) {
            wire.batch_counts[static_cast<std::size_t>(from)] += wire.batch_count;
            if (from > 0 || wire.brings_events()) continue;
            wire.target->data = wire.batch.data();
            wire.target->times = wire.batch_times.data();
            wire.target->count = wire.batch_count;
            continue;
        }
        if (wire.mode == patch::WireMode::linear) interpolate(wire, j, from, frames);
        else
            for (int i = from; i < from + frames; ++i)
                std::memcpy(wire.glide.data() + static_cast<std::size_t>(i) * wire.type->size, wire.current.data(),
                            wire.type->size);
        if (!wire.target) continue;
        wire.target->data = wire.glide.data();
        wire.target->stride = static_cast<std::ptrdiff_t>(wire.type->size);
    }
}

}  // namespace tactus::run
