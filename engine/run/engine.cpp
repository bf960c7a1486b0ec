// SPDX-License-Identifier: Apache-2.0
#include "engine/run/engine.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "engine/run/live_run.hpp"
#include "graph/patch/sub_patch.hpp"

#include <utility>

namespace tactus::run {

namespace {

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
      losses_(host_.notices),
      recorder_(options_, host_, losses_),
      context_{.host = host_,
               .block = options.block,
               .hash = options.hash,
               .constants = {},
               .take = {},
               .observer = options.observer},
      timeline_(options_, context_, recorder_),
      edits_(options_, context_, timeline_, recorder_),
      pause_(timeline_),
      offline_(options_, timeline_, recorder_) {
    if (options_.devices) host_.imitate(*options_.devices);
    if (options_.take || options_.tap)
        context_.take = [this](const io::FrameLayout& layout, const GroupRuntime& group) {
            return recorder_.stream_for(layout, group);
        };
    if (options_.replay && options_.replay->plan_hash != plan_hash_)
        throw Error("the timing log was made with another patch or other settings; replay needs the same");
    if (options_.take) options_.take->begin(plan.patch, plan_hash_);
    host_.begin(plan.patch);
    timeline_.begin(std::move(plan));
}

Engine::~Engine() = default;

void Engine::schedule(compile::Plan plan, Flicks when) { timeline_.schedule(std::move(plan), when); }

void Engine::schedule_change(std::int64_t id, const std::string& node, const std::string& param, double value) {
    timeline_.schedule_change(id, node, param, value);
}

void Engine::render(int threads, const std::function<void(double)>& progress) { offline_.run(threads, progress); }

void Engine::run_live(const LiveOptions& options) {
    if (options.log) recorder_.open_log(*options.log, plan_hash_, options_.seconds);
    LiveRun({host_, timeline_, recorder_, edits_, pause_}, options).run();
}

void Engine::edit(std::function<compile::Plan()> make, std::function<void(const EditOutcome&)> told) {
    edits_.edit(std::move(make), std::move(told));
}

Flicks Engine::set(const std::string& node, const std::string& param, const std::string& text) {
    return edits_.set(node, param, text);
}

void Engine::record(bool wanted) { recorder_.want(wanted); }

void Engine::stop() { offline_.stop(); }

void Engine::complete() { recorder_.finish(port_hashes()); }

void Engine::finish() {
    complete();
    if (!losses().empty()) throw Error(losses().front());
}

Report Engine::report() const { return timeline_.report(); }

Engine::PortHashes Engine::port_hashes() const { return timeline_.port_hashes(); }

std::uint64_t Engine::output_hash() const {
    Hash hash;
    for (const auto& [name, port] : port_hashes()) {
        hash.add_text(name);
        hash.add_word(port);
    }
    return hash.value();
}

double Engine::progress_seconds() const { return timeline_.progress_seconds(); }

}  // namespace tactus::run
