// SPDX-License-Identifier: Apache-2.0
// Recording a stretch of a live run. What timing decided is in the take from the beginning; only values begin and end.
#include "engine/run/engine.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::run {

namespace {

// Between making the streams and their first values: time enough to hand them to every group.
constexpr Flicks record_lead = flicks_per_second / 50;

}  // namespace

void Engine::record(bool wanted) {
    if (!options_.take) throw Error("this run keeps no journal, so it cannot be recorded from here; begin it anew");
    if (wanted && options_.take->is_lost()) throw Error(options_.take->loss());
    wants_record_ = wanted;
}

void Engine::service_record() {
    if (!options_.take) return;
    if (!was_recorded_ && options_.take->size() > options_.longest_journal)
        return give_up_journal(fmt::format("its journal has grown beyond {} MB", options_.longest_journal >> 20));
    // Whoever builds a plan makes streams for it.
    if (building_.valid()) return;
    bool ended = false;
    for (const Tap& tap : ending_taps_) {
        if (tap.stream->is_finished()) continue;
        if (tap.group->done() < tap.stream->until() && !tap.group->is_over()) continue;
        tap.stream->finish();
        ended = true;
    }
    if (ended) list_open_taps();
    // A plan that is on its way has its streams already, or was built without any.
    if (wants_record_ == records_ || before_) return;
    wants_record_ ? begin_record() : end_record();
}

void Engine::begin_record() {
    records_ = was_recorded_ = true;
    std::vector<std::pair<build::PublishedOutput*, RecordStream*>> begun;
    for (std::size_t g = 0; g < now_->groups.size(); ++g)
        for (build::PublishedOutput& output : now_->programs[g]->published)
            begun.emplace_back(&output, tap_of(output.name, *output.port->type, *now_->groups[g]));
    list_open_taps();
    const Flicks from = furthest() + record_lead;
    for (const auto& [name, tap] : taps_) tap.stream->begin_at(ceil_div(from, tap.group->plan->period));
    for (const auto& [output, stream] : begun) output->record_into(stream);
}

/// The streams stay where they are written to: past their end they keep nothing.
void Engine::end_record() {
    records_ = false;
    const Flicks until = furthest() + record_lead;
    for (auto& [name, tap] : taps_) {
        tap.stream->end_at(ceil_div(until, tap.group->plan->period));
        ending_taps_.push_back(std::move(tap));
    }
    taps_.clear();
}

void Engine::give_up_journal(const std::string& why) {
    options_.take = nullptr;
    wants_record_ = records_;
    host_.notices.push_back(fmt::format("this run can no longer be recorded: {}", why));
}

}  // namespace tactus::run
