// SPDX-License-Identifier: Apache-2.0
#include "engine/run/engine.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "engine/run/live_run.hpp"
#include "graph/patch/sub_patch.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

namespace tactus::run {

namespace {

/// Hash of the patch, including changes by the command line.
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

/// Never destroys `thing`: threads that were left behind in drivers may still refer to it.
void keep_for_ever(std::shared_ptr<const void> thing) {
    static std::mutex lock;
    // Not destroyed at the end of the program either.
    static auto& kept = *new std::vector<std::shared_ptr<const void>>;
    const std::lock_guard guard(lock);
    kept.push_back(std::move(thing));
}

}  // namespace

Engine::Parts::Parts(const EngineOptions& options_)
    : options(options_),
      host(options.folder, options.live, options.audio),
      losses(host.notices),
      recorder(options, host, losses),
      context{.host = host,
              .block = options.block,
              .hash = options.hash,
              .constants = {},
              .take = {},
              .observer = options.observer,
              .only_checked = options.only_checked},
      timeline(options, context, recorder),
      edits(options, context, timeline, recorder, time),
      pause(timeline, time),
      offline(options, timeline, recorder) {
    if (options.devices) host.imitate(*options.devices);
    if (options.replay) host.hear_from_log();
    if (options.only_checked) host.describe_hardware();
    if (options.take || options.tap)
        context.take = [this](const io::FrameLayout& layout, const GroupRuntime& group) {
            return recorder.stream_for(layout, group);
        };
}

Engine::Engine(compile::Schedule plan, const EngineOptions& options)
    : plan_hash_(hash_of(plan.patch)), parts_(std::make_shared<Parts>(options)) {
    if (options.replay && options.replay->plan_hash != plan_hash_)
        throw Error("the timing log was made with another patch or other settings; replay needs the same");
    if (options.take) options.take->begin(plan.patch, plan_hash_);
    parts_->host.begin(plan.patch);
    parts_->timeline.begin(std::move(plan));
}

Engine::~Engine() = default;

void Engine::schedule(compile::Schedule plan, Flicks when) { parts_->timeline.schedule(std::move(plan), when); }

void Engine::schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value) {
    parts_->timeline.schedule_change(id, node, param, value);
}

void Engine::render(int threads, const std::function<void(double)>& progress) {
    parts_->offline.run(threads, progress);
}

void Engine::advance(Flicks until) {
    Flicks& now = parts_->time.advanced;
    if (now < 0)
        for (const auto& group : groups()) group->decide_advanced(parts_->time.window);
    parts_->offline.advance(until);
    now = std::max(now, until);
}

void Engine::run_live(const LiveOptions& options) {
    Parts& p = *parts_;
    if (options.log) p.recorder.open_log(*options.log, plan_hash_, p.options.seconds);
    const auto run =
        std::make_shared<LiveRun>(LiveParts{p.host, p.timeline, p.recorder, p.edits, p.time, p.pause}, options);
    struct Keep {
        ~Keep() {
            if (!run->has_left_threads()) return;
            keep_for_ever(run);
            keep_for_ever(parts);
        }
        const std::shared_ptr<LiveRun>& run;
        const std::shared_ptr<Parts>& parts;
    } const keep{run, parts_};
    run->run();
}

void Engine::edit(std::function<compile::Schedule()> make, std::function<void(const EditOutcome&)> told) {
    parts_->edits.edit(std::move(make), std::move(told));
}

Flicks Engine::set(const std::string& node, const std::string& param, const std::string& text) {
    return parts_->edits.set(node, param, text);
}

void Engine::record(bool wanted) { parts_->recorder.want(wanted); }

void Engine::stop() { parts_->offline.stop(); }

void Engine::complete() { parts_->recorder.finish(port_hashes()); }

void Engine::finish() {
    complete();
    if (!losses().empty()) throw Error(losses().front());
}

Report Engine::report() const { return parts_->timeline.report(); }

Engine::PortHashes Engine::port_hashes() const { return parts_->timeline.port_hashes(); }

std::uint64_t Engine::output_hash() const {
    Hash hash;
    for (const auto& [name, port] : port_hashes()) {
        hash.add_text(name);
        hash.add_word(port);
    }
    return hash.value();
}

double Engine::progress_seconds() const { return parts_->timeline.progress_seconds(); }

}  // namespace tactus::run
