// SPDX-License-Identifier: Apache-2.0
#include "engine/run/recorder.hpp"

#include "dsp/core/error.hpp"
#include "engine/run/timeline.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_set>
#include <utility>

namespace tactus::run {

namespace {

// Between making the streams and their first values: time enough to hand them to every group.
constexpr Flicks record_lead = flicks_per_second / 50;

TapMaker tap_maker(const EngineOptions& options) {
    if (!options.take) return options.tap;
    return [take = options.take, tap = options.tap](const io::FrameLayout& layout,
                                                    const GroupRuntime& group) -> std::unique_ptr<io::Sink> {
        std::unique_ptr<io::Sink> other = tap ? tap(layout, group) : nullptr;
        std::unique_ptr<io::Sink> taken = take->sink(layout, group);
        return io::both_sinks(std::move(taken), std::move(other));
    };
}

}  // namespace

Recorder::Recorder(const EngineOptions& options, io::EngineHost& host, Losses& losses)
    : host_(host),
      losses_(losses),
      take_(options.take),
      longest_journal_(options.longest_journal),
      journal_(options.take),
      taps_(tap_maker(options)) {
    if (!options.take) return;
    wants_ = records_ = options.take_values == TakeValues::all;
    was_recorded_ = options.take_values != TakeValues::on_request;
}

RecordStream* Recorder::stream_for(const io::FrameLayout& layout, const GroupRuntime& group) {
    return records_ ? taps_.get(layout, group) : nullptr;
}

void Recorder::keep_opened() {
    const std::size_t known = host_.devices.size();
    host_.keep();
    for (std::size_t i = known; take_ && i < host_.devices.size(); ++i) take_->device(*host_.devices[i]);
    taps_.update();
}

void Recorder::want(bool wanted) {
    if (!take_) throw Error("this run keeps no journal, so it cannot be recorded from here; restart it");
    if (wanted && take_->is_lost()) throw Error(take_->loss());
    wants_ = wanted;
    // Who asks for values while the run goes on gets all of them.
    if (wanted) take_->limit_values(0);
}

void Recorder::service(Timeline& timeline, bool is_building, Flicks now) {
    if (!take_) return;
    if (!was_recorded_ && take_->size() > longest_journal_)
        return give_up(fmt::format("its journal has grown beyond {} MB", longest_journal_ >> 20));
    if (is_building) return;
    note_limit();
    taps_.finish_past();
    // A plan that is on its way has its streams already, or was built without any.
    if (wants_ == records_ || timeline.is_changing()) return;
    wants_ ? begin(timeline, now) : end(now);
}

void Recorder::note_limit() {
    if (has_noted_limit_) return;
    const std::optional<double> at = take_->values_limited_at();
    if (!at) return;
    has_noted_limit_ = true;
    host_.notices.push_back(
        fmt::format("the take holds values up to {:.4g} s, {} MB; it repeats the rest ('replay --record' writes all, "
                    "'--values' records all)",
                    *at, take::max_first_bytes / 1'000'000));
}

void Recorder::begin(Timeline& timeline, Flicks time) {
    records_ = was_recorded_ = true;
    std::vector<std::pair<build::GroupProgram*, RecordStream*>> begun;
    build::Generation& now = timeline.now();
    for (std::size_t g = 0; g < now.groups.size(); ++g)
        if (build::GroupProgram& program = *now.programs[g]; !program.layout.columns.empty())
            begun.emplace_back(&program, taps_.get(program.layout, *now.groups[g]));
    taps_.update();
    taps_.begin_at(time + record_lead);
    for (const auto& [program, stream] : begun) program->recorded.store(stream, std::memory_order_release);
}

void Recorder::end(Flicks now) {
    records_ = false;
    taps_.end_at(now + record_lead);
}

void Recorder::give_up(const std::string& why) {
    take_ = nullptr;
    journal_.forget_take();
    wants_ = records_;
    host_.notices.push_back(fmt::format("this run can no longer be recorded: {}", why));
}

void Recorder::open_log(const std::filesystem::path& path, std::uint64_t plan_hash, double seconds) {
    journal_.open(path, plan_hash, seconds);
}

void Recorder::close_log() { journal_.close(); }

void Recorder::drain_journal(const std::vector<std::shared_ptr<GroupRuntime>>& groups) {
    if (!journal_.is_used()) return;
    const std::lock_guard lock(journal_lock_);
    journal_.drain(groups);
    // The take has not been requested yet.
    if (take_ && !was_recorded_ && take_->is_lost()) give_up(take_->loss());
}

void Recorder::detach(GroupRuntime& group) {
    const std::lock_guard lock(journal_lock_);
    journal_.detach(group);
}

void Recorder::lose_journal(const std::string& why, bool is_asked_for) {
    journal_.abandon();
    if (take_) take_->lose(why);
    if (is_asked_for || was_recorded_) losses_.note(why);
}

void Recorder::drain() {
    for (const auto& stream : host_.streams) stream->drain();
    taps_.drain();
}

void Recorder::drain_full() {
    for (const auto& stream : host_.streams)
        if (stream->wants_drain()) stream->drain();
    taps_.drain_full();
}

void Recorder::finish_ended(const Timeline& timeline) {
    std::unordered_set<const RecordStream*> in_use;
    for (const auto& program : timeline.now().programs) in_use.insert(program->recorded.load());
    taps_.finish_ended(in_use);
    for (const auto& node : timeline.now().nodes) in_use.insert(node->uses.streams.begin(), node->uses.streams.end());
    for (const auto& stream : host_.streams)
        if (!in_use.contains(stream.get())) stream->finish();
}

void Recorder::finish(const PortHashes& hashes) {
    for (const auto& stream : host_.streams) stream->finish();
    taps_.finish();
    for (const auto& card : host_.cards) card->close();
    if (take_) {
        take_->finish(hashes);
        note_limit();
        taps_.note_drops(losses_);
    }
    note_losses();
}

void Recorder::note_losses() {
    for (const auto& stream : host_.streams) losses_.note(stream->loss());
    taps_.note_losses(losses_);
    if (take_ && was_recorded_) losses_.note(take_->loss());
    const std::lock_guard lock(journal_lock_);
    losses_.note(journal_.loss());
}

}  // namespace tactus::run
