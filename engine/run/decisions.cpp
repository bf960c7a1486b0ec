// SPDX-License-Identifier: Apache-2.0
#include "engine/run/decisions.hpp"

#include "dsp/core/clock.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/run/link.hpp"
#include "engine/take/sound_record.hpp"

#include <algorithm>

namespace tactus::run {

void DecisionLog::note(take::TimingKind kind, std::int64_t tick, const Entry& entry) noexcept {
    if (!ring) return;
    take::TimingRecord record;
    record.kind = kind;
    record.group = group_;
    record.source = static_cast<std::uint32_t>(entry.source);
    record.count = static_cast<std::int32_t>(entry.count);
    record.tick = tick;
    record.value = entry.value;
    if (entry.sample) record.sample = *entry.sample;
    if (!ring->push(record)) overflow.store(true, std::memory_order_relaxed);
}

std::int64_t Decisions::skip_from(std::int64_t tick) const noexcept { return tick; }

bool Decisions::has_changes() noexcept { return false; }

bool Decisions::is_replayed() const noexcept { return false; }

bool Decisions::holds_off(std::int64_t, bool before) noexcept { return before; }

std::int64_t Decisions::awaited(const Link& link, std::int64_t tick) const noexcept { return link.wanted(tick); }

std::int64_t Decisions::readable_until(const Link& link, const GroupRuntime& producer, std::int64_t tick,
                                       std::int64_t until) const noexcept {
    const std::int64_t last = producer.done() - 1;
    if (last >= producer.end.load(std::memory_order_relaxed) - 1) return until;
    return std::min(until, std::max(link.first_after(last), tick + 1));
}

bool Decisions::has_room(const std::vector<Link*>& links, std::int64_t tick, int frames) const noexcept {
    return std::ranges::all_of(links, [&](const Link* link) { return link->has_room(tick, frames); });
}

bool Decisions::may_begin(const std::vector<Link*>& links, std::int64_t tick) const noexcept {
    return has_room(links, tick, 1);
}

void Decisions::acquire(io::DeviceSlot& slot, std::int64_t tick, Flicks elapsed) noexcept {
    sample(slot, elapsed);
    if (driver.is_forsaken()) return;
    log_.note(take::TimingKind::device_sample, tick, {slot.id, 1, 0, &slot.port.sample});
}

/// On the virtual clock groups wait for each other.
int Decisions::overdue(const io::DeviceSlot&, const std::vector<build::ValueSource>&, std::int64_t) noexcept {
    return -1;
}

void Decisions::hear(io::SoundHeard& heard, std::int64_t tick, int frames, std::int64_t due_ns) noexcept {
    heard.fill(tick, frames, due_ns);
    note_heard(heard, tick, frames);
}

/// Every record begins with the call, so that the log stays in the order of time: the last `value` activations of each
/// are those of its samples.
void Decisions::note_heard(const io::SoundHeard& heard, std::int64_t tick, int frames) noexcept {
    if (!log_.ring) return;
    for (int from = 0; from < frames; from += take::sound_record_samples) {
        const int count = std::min(frames - from, take::sound_record_samples);
        const DeviceSample packed = take::pack_sound(heard.port.samples.data() + from, count);
        log_.note(take::TimingKind::heard, tick, {heard.id, from + count, count, &packed});
    }
}

bool Decisions::drops(const Link&, std::int64_t, int) noexcept { return false; }

void Decisions::pass(std::int64_t) noexcept {}

std::int64_t Decisions::newest(const Link& link, const GroupRuntime& producer, std::int64_t tick) noexcept {
    const std::int64_t wanted = link.wanted(tick);
    return wanted > link.used() ? link.newest_available(wanted, producer.done()) : link.used();
}

bool Decisions::is_late(const Link& link, std::int64_t index, std::int64_t last, std::int64_t tick) noexcept {
    const std::int64_t wanted = link.wanted(tick);
    return index < std::min(wanted, last) && link.misses(wanted);
}

void Decisions::let_rest(io::DeviceSlot& slot) noexcept {
    if (!driver.enter()) return;
    slot.guard.commit(*slot.device, {}, steady_ns());
    driver.leave();
}

void Decisions::sample(io::DeviceSlot& slot, Flicks elapsed) noexcept {
    if (!driver.enter()) return;
    const DeviceSample sample = slot.device->acquire(seconds(elapsed));
    if (!driver.leave()) return;
    slot.port.sample = sample;
    slot.port.sample.valid = is_good(sample);
    slot.port.sample.taken = slot.guard.was_taken();
    slot.port.sample.sound_lost = slot.guard.is_asked_to_fade();
}

}  // namespace tactus::run
