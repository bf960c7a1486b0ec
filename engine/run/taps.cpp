// SPDX-License-Identifier: Apache-2.0
#include "engine/run/taps.hpp"

#include "engine/run/group_runtime.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::run {

RecordStream* Taps::get(const std::string& port, const ValueType& type, const GroupRuntime& group) {
    const std::string name = fmt::format("{} {} {}", port, group.index, type.name);
    Tap& tap = taps_[name];
    if (!tap.stream) tap = {make_(port, type, group), &group};
    return tap.stream.get();
}

void Taps::update() {
    open_.clear();
    const auto add = [this](const Tap& tap) {
        if (tap.stream && !tap.stream->is_finished()) open_.push_back(tap.stream.get());
    };
    for (const auto& [name, tap] : taps_) add(tap);
    for (const Tap& tap : ending_) add(tap);
}

void Taps::begin_at(Flicks from) {
    for (const auto& [name, tap] : taps_) tap.stream->begin_at(ceil_div(from, tap.group->plan->period));
}

/// Groups still hold the streams and write to them: past their end they keep nothing.
void Taps::end_at(Flicks until) {
    for (auto& [name, tap] : taps_) {
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

void Taps::finish_ended() {
    for (const auto& [name, tap] : taps_)
        if (tap.stream && tap.group->is_over()) tap.stream->finish();
    for (const Tap& tap : ending_)
        if (tap.stream && tap.group->is_over()) tap.stream->finish();
    update();
}

void Taps::finish() {
    for (io::Stream* tap : open_) tap->finish();
    for (auto& [name, tap] : taps_) ending_.push_back(std::move(tap));
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
    for (const Tap& tap : ending_)
        if (tap.stream) losses.note(tap.stream->loss());
}

void Taps::note_drops(Losses& losses) const {
    for (const Tap& tap : ending_)
        if (tap.stream && tap.stream->dropped() > 0)
            losses.note(fmt::format("the take is not whole: {} values of {} were lost because the disk was too slow",
                                    tap.stream->dropped(), tap.stream->format().file));
}

}  // namespace tactus::run
