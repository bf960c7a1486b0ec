// SPDX-License-Identifier: Apache-2.0
#include "engine/run/engine.hpp"

#include "dsp/core/realtime.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::run {

namespace {

// From the first fading tick to the switch: a fade takes 10 ms.
constexpr Flicks fade_lead = flicks_per_second / 50;

/// Over all that a patch says and a command line changed.
std::uint64_t hash_of(const patch::Patch& patch) {
    Hash hash;
    hash.add_text(patch::bundle_text(patch));
    for (const patch::PatchNode& node : patch.nodes)
        for (const OptionText& setting : node.settings) {
            hash.add_text(node.name);
            hash.add_text(setting.name);
            hash.add_text(setting.text);
        }
    for (const patch::PatchDevice& device : patch.devices)
        for (const OptionText& setting : device.settings) {
            hash.add_text(setting.name);
            hash.add_text(setting.text);
        }
    for (const patch::PatchAsset& asset : patch.assets) hash.add_text(asset.path.filename().string());
    hash.add_word(patch.seed);
    return hash.value();
}

}  // namespace

Engine::Engine(compile::Plan plan, const EngineOptions& options)
    : options_(options),
      plan_hash_(hash_of(plan.patch)),
      host_(options.folder, options.live, options.audio),
      context_{.host = host_,
               .block = options.block,
               .hash = options.hash,
               .constants = {},
               .take = {},
               .observer = options.observer} {
    if (options_.devices) host_.imitate(*options_.devices);
    if (options_.take && !options_.tap) {
        options_.tap = [this](const std::string& port, const ValueType& type, const GroupRuntime& group) {
            return options_.take->stream(port, type, group);
        };
        wants_record_ = records_ = was_recorded_ = options_.record_values;
    } else records_ = true;
    if (options_.tap)
        context_.take = [this](const std::string& port, const ValueType& type, const GroupRuntime& group) {
            return records_ ? tap_of(port, type, group) : nullptr;
        };
    if (options_.replay && options_.replay->plan_hash != plan_hash_)
        throw Error("the timing log was made with another patch or other settings; replay needs the same");
    if (options_.take) options_.take->begin(plan.patch, plan_hash_);
    host_.begin(plan.patch);
    now_ = build::build_generation(std::move(plan), nullptr, context_);
    keep_opened();
    adopt_groups(*now_, 0);
    for (std::size_t g = 0; g < now_->groups.size(); ++g) now_->groups[g]->scheduled.push_back(now_->programs[g].get());
}

RecordStream* Engine::tap_of(const std::string& port, const ValueType& type, const GroupRuntime& group) {
    const std::string name = fmt::format("{} {} {}", port, group.index, type.name);
    Tap& tap = taps_[name];
    if (!tap.stream) tap = {options_.tap(port, type, group), &group};
    return tap.stream.get();
}

/// What the nodes of a new generation opened belongs to the run from now on.
void Engine::keep_opened() {
    const std::size_t known = host_.devices.size();
    host_.keep();
    for (std::size_t i = known; options_.take && i < host_.devices.size(); ++i)
        options_.take->device(*host_.devices[i]);
    list_open_taps();
}

void Engine::list_open_taps() {
    open_taps_.clear();
    const auto list = [this](const Tap& tap) {
        if (tap.stream && !tap.stream->is_finished()) open_taps_.push_back(tap.stream.get());
    };
    for (const auto& [name, tap] : taps_) list(tap);
    for (const Tap& tap : ending_taps_) list(tap);
}

Engine::~Engine() = default;

std::int64_t Engine::tick_at(double time, Flicks period) const {
    const double ticks = time * static_cast<double>(flicks_per_second) / static_cast<double>(period);
    // The last activation is the last that starts before the end; the nudge keeps 0.1 s at 1 kHz at 100.
    return static_cast<std::int64_t>(std::ceil(ticks - 1e-6));
}

/// Gives every group of a generation its program; groups that are new start at `when`, those that are gone end there.
void Engine::adopt_groups(const build::Generation& generation, Flicks when) {
    for (std::size_t g = 0; g < generation.groups.size(); ++g) {
        GroupRuntime& group = *generation.groups[g];
        build::GroupProgram& program = *generation.programs[g];
        program.switch_time = when;
        program.fade_time = program.changes_force ? when - fade_lead : when;
        if (generation.group_is_new[g]) {
            groups_.push_back(generation.groups[g]);
            group.start_at(ceil_div(when, group.plan->period));
            set_end(group);
            group.times_nodes = options_.time_nodes;
            if (options_.take || log_) add_log(group);
        }
    }
    // Where a group of a replayed run ended is in the log.
    for (const auto& group : groups_)
        if (!options_.replay && !generation.keeps(group.get()))
            group->end = std::min(group->end.load(), ceil_div(when, group->plan->period));
}

void Engine::set_end(GroupRuntime& group) const {
    group.end = tick_at(options_.seconds, group.plan->period);
    if (!options_.replay) return;
    static const std::vector<take::TimingRecord> nothing;
    const auto index = static_cast<std::size_t>(group.index);
    group.replayed = index < options_.replay->groups.size() ? &options_.replay->groups[index] : &nothing;
    group.replayed_changes = &replayed_changes_;
    group.end = std::min(group.end.load(), options_.replay->end_of(index, group.plan->period));
}

void Engine::add_log(GroupRuntime& group) {
    group.log = log_rings_.emplace_back(std::make_unique<Ring<take::TimingRecord>>(1 << 14)).get();
}

void Engine::schedule(compile::Plan plan, Flicks when) {
    host_.begin(plan.patch);
    std::unique_ptr<build::Generation> next = build::build_generation(std::move(plan), now_.get(), context_);
    keep_opened();
    adopt_groups(*next, when);
    for (std::size_t g = 0; g < next->groups.size(); ++g) next->groups[g]->scheduled.push_back(next->programs[g].get());
    scheduled_.push_back(std::exchange(now_, std::move(next)));
}

void Engine::schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value) {
    const int at = now_->find(node);
    if (at < 0) throw Error(fmt::format("the take sets a parameter of '{}', a node that is not there", node));
    const auto& params = now_->nodes[static_cast<std::size_t>(at)]->params;
    const auto found = params.find(param);
    if (found == params.end()) throw Error(fmt::format("the take sets '{}.{}', which is not there", node, param));
    if (id < 0 || id > 1'000'000) throw Error("the take's list of parameter changes is damaged");
    if (replayed_changes_.size() <= static_cast<std::size_t>(id))
        replayed_changes_.resize(static_cast<std::size_t>(id) + 1);
    replayed_changes_[static_cast<std::size_t>(id)] = {id, 0, found->second, value};
}

/// Hashes of the outputs that end with a generation. A group that never took over the next one ends with its own.
void Engine::gather_hashes(const build::Generation& old, const build::Generation* next, PortHashes& parts) {
    for (std::size_t g = 0; g < old.groups.size(); ++g) {
        const GroupRuntime& group = *old.groups[g];
        const build::GroupProgram& program = *old.programs[g];
        if (old.number > group.generation()) continue;
        const build::GroupProgram* successor = nullptr;
        for (std::size_t n = 0; next && next->number <= group.generation() && n < next->groups.size(); ++n)
            if (next->groups[n] == old.groups[g]) successor = next->programs[n].get();
        std::vector<bool> goes_on(program.published.size());
        if (successor)
            for (const build::PublishedOutput& output : successor->published)
                if (output.before >= 0) goes_on[static_cast<std::size_t>(output.before)] = true;
        for (std::size_t k = 0; k < program.published.size(); ++k) {
            const build::PublishedOutput& output = program.published[k];
            if (!goes_on[k]) parts.emplace_back(output.name, output.value(successor ? program.ran : group.ran()));
        }
    }
}

Engine::PortHashes Engine::port_hashes() const {
    PortHashes parts = ended_hashes_;
    for (std::size_t i = 0; i < scheduled_.size(); ++i)
        gather_hashes(*scheduled_[i], i + 1 < scheduled_.size() ? scheduled_[i + 1].get() : now_.get(), parts);
    if (before_) gather_hashes(*before_, now_.get(), parts);
    gather_hashes(*now_, nullptr, parts);
    // An output that ended and came back has several parts, in the order of the edits.
    std::ranges::stable_sort(parts, {}, [](const auto& part) { return part.first; });
    PortHashes ports;
    for (std::size_t i = 0; i < parts.size();) {
        std::size_t end = i + 1;
        while (end < parts.size() && parts[end].first == parts[i].first) ++end;
        Hash all;
        for (std::size_t k = i; k < end; ++k) all.add_word(parts[k].second);
        ports.emplace_back(parts[i].first, end == i + 1 ? parts[i].second : all.value());
        i = end;
    }
    return ports;
}

std::uint64_t Engine::output_hash() const {
    Hash hash;
    for (const auto& [name, port] : port_hashes()) {
        hash.add_text(name);
        hash.add_word(port);
    }
    return hash.value();
}

double Engine::progress_seconds() const {
    double least = options_.seconds;
    for (const auto& group : now_->groups) least = std::min(least, seconds(group->done() * group->plan->period));
    return least;
}

Report Engine::report() const {
    Report report;
    std::vector<const build::LiveNode*> nodes;
    for (const auto& node : now_->nodes) nodes.push_back(node.get());
    std::ranges::sort(nodes, {}, &build::LiveNode::name);
    for (const build::LiveNode* node : nodes) node->type->report(node->instance.get(), report);
    return report;
}

void Engine::drain_streams() {
    for (const auto& stream : host_.streams) stream->drain();
    for (io::Stream* tap : open_taps_) tap->drain();
}

void Engine::drain_log() {
    if (log_rings_.empty()) return;
    const std::lock_guard lock(log_lock_);
    // What each group had done before its ring is emptied: all up to there is in the log afterwards.
    std::vector<take::TakeWriter::Progress> progress;
    for (const auto& group : groups_) {
        // One that has ended said so in the log.
        if (!group->log) continue;
        const std::int64_t done = group->done();
        progress.push_back({group->index, done, done * group->plan->period});
    }
    take::TimingRecord record;
    for (const auto& ring : log_rings_)
        while (ring->pop(record)) {
            if (log_) write_log(record);
            if (options_.take) options_.take->record(record);
        }
    if (options_.take) options_.take->checkpoint(progress);
    // Nobody has asked for it yet.
    if (options_.take && !was_recorded_ && options_.take->is_lost()) give_up_journal(options_.take->loss());
}

void Engine::write_log(const take::TimingRecord& record) {
    try {
        log_->write(record);
    } catch (const Error& error) {
        log_loss_ = error.message();
        complete_log();
    }
}

/// A log that had no room ends with what it has, under its own name.
void Engine::complete_log() {
    try {
        log_->finish();
    } catch (const Error& error) {
        if (log_loss_.empty()) log_loss_ = error.message();
    }
    log_.reset();
}

void Engine::note_loss(const std::string& loss) {
    if (loss.empty() || std::ranges::find(losses_, loss) != losses_.end()) return;
    losses_.push_back(loss);
    host_.notices.push_back(fmt::format("not written to its end: {}", loss));
}

void Engine::note_losses() {
    for (const auto& stream : host_.streams) note_loss(stream->loss());
    // Whoever builds a plan adds to the list of all taps.
    for (io::Stream* tap : open_taps_) note_loss(tap->loss());
    for (const Tap& tap : ending_taps_)
        if (tap.stream) note_loss(tap.stream->loss());
    if (options_.take && was_recorded_) note_loss(options_.take->loss());
    const std::lock_guard lock(log_lock_);
    note_loss(log_loss_);
}

void Engine::complete() {
    for (const auto& stream : host_.streams) stream->finish();
    for (io::Stream* tap : open_taps_) tap->finish();
    for (const auto& card : host_.cards) card->close();
    for (auto& [name, tap] : taps_) ending_taps_.push_back(std::move(tap));
    taps_.clear();
    if (options_.take) {
        options_.take->finish(port_hashes());
        for (const Tap& tap : ending_taps_)
            if (tap.stream && tap.stream->dropped() > 0)
                note_loss(fmt::format("the take is not whole: {} values of {} were lost because the disk was too slow",
                                      tap.stream->dropped(), tap.stream->format().file));
    }
    note_losses();
}

void Engine::finish() {
    complete();
    if (!losses_.empty()) throw Error(losses_.front());
}

void Engine::stop() {
    stop_ = true;
    generation_.fetch_add(1);
    generation_.notify_all();
}

void Engine::fail(std::exception_ptr error) {
    const std::lock_guard lock(failure_lock_);
    if (!failure_) failure_ = std::move(error);
    stop();
}

}  // namespace tactus::run
