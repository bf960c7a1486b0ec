// SPDX-License-Identifier: Apache-2.0
#include "tools/view/take_bench.hpp"

#include "engine/engine.hpp"
#include "tools/load_plan.hpp"
#include "tools/replayed_take.hpp"
#include "tools/scene_outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tactus::view {

namespace {

/// Ends a repetition that nobody waits for any more.
struct Outdated {};

/// What is seen of a run is there for as long as the run is.
struct Repetition {
    Observer observer{Observer::Pace::lossless};
    std::unique_ptr<ReplayedTake> run;
};

/// What the scenes of all patches of a take need; a text that does not compile needs nothing.
std::set<std::string> scene_ports(const Take& take) {
    std::vector<std::string> texts{take.text};
    for (const auto& event : take.events)
        if (const auto* edit = std::get_if<TakenEdit>(&event)) texts.push_back(edit->text);
    std::set<std::string> all;
    for (const std::string& text : texts) {
        Problems problems;
        const std::optional<Plan> plan = plan_of(read_patch(text, take.about.patch_file, problems),
                                                 take.about.overrides, take.about.seed, nullptr, problems);
        if (!plan) continue;
        const std::vector<std::string> ports = outline_of(*plan).ports();
        all.insert(ports.begin(), ports.end());
    }
    return all;
}

}  // namespace

TakeBench::TakeBench(const std::filesystem::path& folder)
    : take_(Take::load(folder)), feed_(take_), scene_ports_(scene_ports(take_)), thread_([this] { work(); }) {}

TakeBench::~TakeBench() { ends_ = true; }

void TakeBench::go_to(double seconds) {
    const double at = std::clamp(seconds, 0.0, length());
    feed_.set_now(at);
    const std::lock_guard lock(lock_);
    wanted_ = at;
}

void TakeBench::tend(double elapsed) {
    if (!is_playing_) return;
    if (time() >= length()) is_playing_ = false;
    else go_to(time() + elapsed);
}

std::shared_ptr<Observer> TakeBench::scene() const {
    const std::lock_guard lock(lock_);
    return made_scene_;
}

double TakeBench::scene_time() const {
    const std::lock_guard lock(lock_);
    return made_;
}

bool TakeBench::scene_is_there() const {
    const std::lock_guard lock(lock_);
    return made_ == wanted_ || !problem_.empty();
}

std::string TakeBench::scene_note() const {
    const std::lock_guard lock(lock_);
    if (!problem_.empty()) return problem_;
    if (made_ < 0.0) return "bone: running the take again …";
    if (made_ == wanted_) return "";
    return fmt::format("bone as at {:.2f} s …", made_);
}

void TakeBench::work() {
    while (!ends_) {
        double wanted = 0.0;
        {
            const std::lock_guard lock(lock_);
            wanted = wanted_;
        }
        if (wanted == scene_time()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
            continue;
        }
        try {
            repeat_until(wanted);
        } catch (const Outdated&) {
        } catch (const std::exception& error) {
            const std::lock_guard lock(lock_);
            problem_ = error.what();
            made_ = wanted;
        }
    }
}

void TakeBench::repeat_until(double seconds) {
    const auto repetition = std::make_shared<Repetition>();
    Observer& observer = repetition->observer;
    EngineOptions options;
    options.observer = &observer;
    options.hash = options.time_nodes = false;
    // At least one tick of everything: what nodes begin with is only there when they were prepared.
    options.seconds = std::max(seconds, 1e-3);
    repetition->run = std::make_unique<ReplayedTake>(take_, options, assets_);
    for (const std::string& port : scene_ports_) observer.watch(port, Watch::latest);
    repetition->run->engine().render(1, [&](double) {
        if (ends_) throw Outdated();
    });
    observer.advance();
    const std::lock_guard lock(lock_);
    made_scene_ = std::shared_ptr<Observer>(repetition, &observer);
    made_ = seconds;
}

}  // namespace tactus::view
