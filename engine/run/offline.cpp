// SPDX-License-Identifier: Apache-2.0
// The virtual clock: groups run as soon as what they read is there, and wait for each other.
#include "engine/run/engine.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/realtime.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace tactus::run {

void Engine::offline_worker(const std::vector<GroupRuntime*>& mine, std::uint64_t seed) {
    flush_denormals_to_zero();
    const Random random{seed};
    std::uint64_t draws = 0;
    while (!stop_.load(std::memory_order_relaxed)) {
        const std::uint32_t seen = generation_.load(std::memory_order_acquire);
        // Earliest first: then one thread alone never has to wait.
        GroupRuntime* earliest = nullptr;
        bool all_finished = true;
        for (GroupRuntime* group : mine) {
            while (!group->has_begun() && !group->finished() && group->replay_skip()) {
            }
            if (group->finished()) continue;
            if (!group->has_begun() && group->take_changes(Pace::offline)) {
                // Room in channels of the plan before may have become free.
                generation_.fetch_add(1, std::memory_order_release);
                generation_.notify_all();
            }
            all_finished = false;
            const auto release = [](const GroupRuntime* g) { return g->next() * g->plan->period; };
            if (group->ready() && (!earliest || release(group) < release(earliest))) earliest = group;
        }
        if (all_finished) return;
        if (!earliest) {
            generation_.wait(seen, std::memory_order_acquire);
            continue;
        }
        int frames = earliest->max_frames;
        if (options_.random_blocks)
            frames = 1 + static_cast<int>(random.bits(draws++) % static_cast<std::uint64_t>(frames));
        const auto before = std::chrono::steady_clock::now();
        if (!earliest->has_begun()) earliest->begin_call(frames, Pace::offline);
        if (earliest->ready()) earliest->finish_call(Pace::offline);
        earliest->telemetry.execution.add((std::chrono::steady_clock::now() - before).count());
        generation_.fetch_add(1, std::memory_order_release);
        generation_.notify_all();
        for (const auto& stream : host_.streams)
            if (stream->wants_drain()) stream->drain();
        for (io::Stream* tap : open_taps_)
            if (tap->wants_drain()) tap->drain();
        if (options_.observer && options_.observer->wants_drain()) options_.observer->drain();
        if (earliest->log && earliest->log->size() * 2 > earliest->log->capacity()) drain_log();
    }
}

void Engine::render(int threads, const std::function<void(double)>& progress) {
    // The slowest groups do the heavy work: they are dealt out first, the rest shares the last thread.
    const auto count = static_cast<std::size_t>(std::clamp<int>(threads, 1, static_cast<int>(groups_.size())));
    std::vector<std::vector<GroupRuntime*>> shares(count);
    for (std::size_t i = 0; i < groups_.size(); ++i)
        shares[std::min(groups_.size() - 1 - i, count - 1)].push_back(groups_[i].get());
    if (count == 1 && !progress) {
        offline_worker(shares.front(), mix(now_->plan.patch.seed));
        return complete_render();
    }
    std::atomic<std::size_t> running{count};
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < count; ++i)
        workers.emplace_back([this, &shares, &running, i] {
            try {
                offline_worker(shares[i], mix(now_->plan.patch.seed + i));
            } catch (...) {
                fail(std::current_exception());
            }
            --running;
            running.notify_all();
        });
    if (progress) {
        while (running.load() > 0) {
            try {
                progress(progress_seconds() / options_.seconds);
            } catch (...) {
                fail(std::current_exception());
                break;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }
    workers.clear();
    if (failure_) std::rethrow_exception(failure_);
    complete_render();
}

void Engine::complete_render() {
    for (const auto& group : groups_) group->end_at(group->next());
    drain_log();
    drain_streams();
}

}  // namespace tactus::run
