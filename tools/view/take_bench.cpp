// SPDX-License-Identifier: Apache-2.0
#include "tools/view/take_bench.hpp"

#include "engine/engine.hpp"
#include "tools/replayed_take.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace tactus::view {

namespace {

/// Ends a repetition that nobody waits for any more.
struct Outdated {};

}  // namespace

TakeBench::TakeBench(const std::filesystem::path& folder)
    : take_(Take::load(folder)), feed_(take_), thread_([this] { work(); }) {}

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
    auto observer = std::make_shared<Observer>(Observer::Pace::lossless);
    EngineOptions options;
    options.observer = observer.get();
    options.hash = options.time_nodes = false;
    // At least one tick of everything: what nodes begin with is only there when they were prepared.
    options.seconds = std::max(seconds, 1e-3);
    ReplayedTake repeated(take_, options, assets_);
    for (const Observer::Port& port : observer->ports())
        if (port.type->version || port.type == &value::pose || port.type == &value::wrench)
            observer->watch(port.name, Watch::latest);
    repeated.engine().render(1, [&](double) {
        if (ends_) throw Outdated();
    });
    observer->advance();
    const std::lock_guard lock(lock_);
    made_scene_ = std::move(observer);
    made_ = seconds;
}

}  // namespace tactus::view
