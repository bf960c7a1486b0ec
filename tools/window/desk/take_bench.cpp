// SPDX-License-Identifier: Apache-2.0
#include "tools/window/desk/take_bench.hpp"

#include "engine/run/engine.hpp"
#include "tools/render/scene_outline.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/run/replayed_take.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::window {

using render::outline_of;
using run::plan_of;
using run::ReplayedTake;

namespace {

/// Stops a repetition that is no longer needed.
struct Outdated {};

/// Observed values live as long as the run.
struct Repetition {
    observe::Observer observer{observe::Observer::Pace::kept};
    std::unique_ptr<ReplayedTake> run;
};

/// The outputs for the scenes of all patches of a take; a text that does not compile has none.
std::set<std::string> scene_ports(const take::Take& take) {
    std::vector<std::string> texts{take.text};
    for (const auto& event : take.events)
        if (const auto* edit = std::get_if<take::TakenEdit>(&event)) texts.push_back(edit->text);
    std::set<std::string> all;
    for (const std::string& text : texts) {
        patch::Problems problems;
        const std::optional<compile::Schedule> plan = plan_of(patch::read_patch(text, take.about.patch_file, problems),
                                                              take.about.overrides, take.about.seed, nullptr, problems);
        if (!plan) continue;
        const std::vector<std::string> ports = outline_of(*plan).ports();
        all.insert(ports.begin(), ports.end());
    }
    return all;
}

}  // namespace

run::RunChoice choice_of(const take::Take& take) {
    run::RunChoice choice;
    choice.patch = (take.folder / "patch-0.toml").string();
    choice.overrides = take.about.overrides;
    choice.seed = take.about.seed;
    patch::Problems ignored;
    for (const patch::PatchAsset& asset : patch::read_patch(take.text, take.about.patch_file, ignored).assets) {
        const bool is_given = std::ranges::any_of(
            choice.overrides.assets, [&](const std::string& given) { return given.starts_with(asset.name + "="); });
        if (!is_given)
            choice.overrides.assets.push_back(
                fmt::format("{}={}", asset.name, std::filesystem::absolute(asset.path).lexically_normal().string()));
    }
    return choice;
}

TakeBench::TakeBench(const std::filesystem::path& folder)
    : take_(take::Take::load(folder)), feed_(take_), scene_ports_(scene_ports(take_)), thread_([this] { work(); }) {}

TakeBench::~TakeBench() { ends_ = true; }

void TakeBench::go_to(double seconds) {
    feed_.set_now(std::clamp(seconds, 0.0, length()));
    show_scene();
}

void TakeBench::tend(double elapsed) {
    if (is_playing_ && time() >= length()) is_playing_ = false;
    if (is_playing_) go_to(time() + elapsed);
    else show_scene();
}

void TakeBench::show_scene() {
    const std::shared_ptr<observe::Observer> observer = scene();
    if (!observer) return;
    // Instants that the repetition has not completed are not shown.
    observer->advance(static_cast<Flicks>(std::min(time(), repeated()) * static_cast<double>(flicks_per_second)));
}

std::shared_ptr<observe::Observer> TakeBench::scene() const {
    const std::lock_guard lock(lock_);
    return scene_;
}

double TakeBench::repeated() const {
    const std::lock_guard lock(lock_);
    return repeated_;
}

bool TakeBench::scene_is_there() const {
    const std::lock_guard lock(lock_);
    return is_whole_ || repeated_ > time();
}

std::string TakeBench::scene_note() const {
    const std::lock_guard lock(lock_);
    if (!problem_.empty()) return problem_;
    if (is_whole_) return doubt_;
    if (repeated_ < 0.0) return "scene: preparing the repetition …";
    return fmt::format("scene: repeating the run, at {:.1f} s", repeated_);
}

void TakeBench::work() {
    const auto repetition = std::make_shared<Repetition>();
    try {
        std::vector<std::string> doubts = take_.changed_assets();
        if (doubts.empty()) doubts = take_.differences();
        if (!doubts.empty()) {
            const std::lock_guard lock(lock_);
            doubt_ = "the scene may differ: " + doubts.front();
        }
        run::EngineOptions options;
        options.observer = &repetition->observer;
        options.hash = options.time_nodes = false;
        // At least one tick: initial values exist only after the nodes are prepared.
        options.seconds = std::max(length(), 1e-3);
        repetition->run = std::make_unique<ReplayedTake>(take_, options, assets_);
        for (const std::string& port : scene_ports_) repetition->observer.watch(port, observe::Watch::latest, this);
        {
            const std::lock_guard lock(lock_);
            scene_ = std::shared_ptr<observe::Observer>(repetition, &repetition->observer);
            repeated_ = 0.0;
        }
        run::Engine& engine = repetition->run->engine();
        engine.render(1, [&](double) {
            if (ends_) throw Outdated();
            const std::lock_guard lock(lock_);
            repeated_ = engine.progress_seconds();
        });
        const std::lock_guard lock(lock_);
        repeated_ = length();
        is_whole_ = true;
    } catch (const Outdated&) {
    } catch (const std::exception& error) {
        const std::lock_guard lock(lock_);
        problem_ = error.what();
        is_whole_ = true;
    }
}

}  // namespace tactus::window
