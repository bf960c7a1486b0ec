// SPDX-License-Identifier: Apache-2.0
#include "engine/run/taps.hpp"

#include "engine/run/group_runtime.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::run {

namespace {

// How long a disk may make values wait, and the least and most memory for that.
constexpr double waits_s = 2.0;
constexpr std::size_t min_bytes = std::size_t{1} << 20, max_bytes = std::size_t{1} << 26;

io::Stream::Room room_for(const io::FrameLayout& layout, const GroupRuntime& group) {
    const auto frames = static_cast<std::size_t>(group.max_frames);
    const double a_second = static_cast<double>(layout.bytes) * rate_of(group.plan->period);
    const auto wanted = std::clamp(static_cast<std::size_t>(waits_s * a_second), min_bytes, max_bytes);
    return {layout.bytes, frames, std::max(wanted, 4 * frames * layout.bytes)};
}

}  // namespace

RecordStream* Taps::get(const io::FrameLayout& layout, const GroupRuntime& group) {
    for (const Tap& tap : taps_)
        if (tap.group == &group && tap.layout == layout && !(tap.stream && tap.stream->is_finished()))
            return tap.stream.get();
    StreamFormat format;
    format.file = fmt::format("the streams of group '{}'", group.plan->name);
    format.period = group.plan->period;
    Tap& tap = taps_.emplace_back(Tap{nullptr, &group, layout});
    if (std::unique_ptr<io::Sink> sink = make_(layout, group))
        tap.stream = std::make_unique<io::Stream>(format, std::move(sink), room_for(layout, group));
    return tap.stream.get();
}

void Taps::update() {
    open_.clear();
    const auto add = [this](const Tap& tap) {
        if (tap.stream && !tap.stream->is_finished()) open_.push_back(tap.stream.get());
    };
    for (const Tap& tap : taps_) add(tap);
    for (const Tap& tap : ending_) add(tap);
}

void Taps::begin_at(Flicks from) {
    for (const Tap& tap : taps_)
        if (tap.stream) tap.stream->begin_at(ceil_div(from, tap.group->plan->period));
}

/// Groups still hold the streams and write to them: past their end they keep nothing.
void Taps::end_at(Flicks until) {
    for (Tap& tap : taps_) {
        if (!tap.stream) continue;
        tap.stream->end_at(ceil_div(until, tap.group->plan->period));
        ending_.push_back(std::move(tap));
    }
    taps_.clear();
}

void Taps::finish_past() {
    bool finished = false;
    for (const Tap& tap : ending_) {
        if (tap.stream->is_finished()) continue;
        if (tap.group->done() < tap.stream->until() && !tap.group->is_over()) continue;
        tap.stream->finish();
        finished = true;
    }
    if (finished) update();
}

void Taps::finish_ended(const std::unordered_set<const RecordStream*>& in_use) {
    for (auto tap = taps_.begin(); tap != taps_.end();) {
        if (!tap->group->is_over() && in_use.contains(tap->stream.get())) {
            ++tap;
            continue;
        }
        if (tap->stream) {
            tap->stream->finish();
            ending_.push_back(std::move(*tap));
        }
        tap = taps_.erase(tap);
    }
    for (const Tap& tap : ending_)
        // The group of one that is finished may be gone.
        if (!tap.stream->is_finished() && tap.group->is_over()) tap.stream->finish();
    update();
}

void Taps::finish() {
    for (io::Stream* tap : open_) tap->finish();
    for (Tap& tap : taps_)
        if (tap.stream) ending_.push_back(std::move(tap));
    taps_.clear();
}

void Taps::drain() {
    for (io::Stream* tap : open_) tap->drain();
}

void Taps::drain_full() {
    for (io::Stream* tap : open_)
        if (tap->wants_drain()) tap->drain();
}

void Taps::note_losses(Losses& losses) const {
    // Whoever builds a plan adds to `taps_`.
    for (io::Stream* tap : open_) losses.note(tap->loss());
    for (const Tap& tap : ending_) losses.note(tap.stream->loss());
}

void Taps::note_drops(Losses& losses) const {
    for (const Tap& tap : ending_)
        if (tap.stream->dropped() > 0)
            losses.note(fmt::format("the take is not whole: {} ticks of {} were lost because the disk was too slow",
                                    tap.stream->dropped(), tap.stream->format().file));
}

}  // namespace tactus::run
