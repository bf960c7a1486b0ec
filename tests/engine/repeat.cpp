// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/repeat.hpp"

#include "dsp/core/random.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

namespace tactus::test {

void check_replays(const std::function<compile::Schedule()>& plan, double seconds, const std::filesystem::path& log,
                   const run::Engine::PortHashes& live) {
    const take::TimingLog recorded = take::TimingLog::load(log);
    for (const int threads : {1, 3})
        for (const bool random : {false, true})
            for (const int block : {0, 1, 480}) {
                INFO(threads << " threads, blocks of " << block << (random ? " at random" : ""));
                run::EngineOptions options;
                options.seconds = seconds;
                options.replay = &recorded;
                options.block = block;
                options.random_blocks = random;
                run::Engine replay(plan(), options);
                replay.render(threads);
                CHECK(replay.port_hashes() == live);
            }
}

Repetition repeat(const std::filesystem::path& folder, int threads) {
    const take::Take take = take::Take::load(folder);
    take::TakeComparison comparison(take);
    run::EngineOptions options;
    options.seconds = take.about.seconds;
    options.replay = &take.log;
    options.devices = &take.devices;
    options.tap = [&comparison](const io::FrameLayout& layout, const run::GroupRuntime& group) {
        return comparison.tap(layout, group);
    };
    run::Engine engine(compile_text(take.text), options);
    for (const auto& event : take.events) {
        if (const auto* edit = std::get_if<take::TakenEdit>(&event))
            engine.schedule(compile_text(edit->text), edit->when);
        if (const auto* change = std::get_if<take::TakenChange>(&event))
            engine.schedule_change(change->id, change->node, change->param, change->value);
    }
    engine.render(threads);
    engine.finish();
    Repetition repetition{engine.port_hashes(), comparison.compared_values(), comparison.first_difference(), true};
    for (const auto& [port, hash] : repetition.hashes) {
        const auto expected = take.result.find(port);
        repetition.matches_result =
            repetition.matches_result && expected != take.result.end() && expected->second == hash;
    }
    return repetition;
}

std::filesystem::path scratch(const std::string& name) {
    static std::atomic<int> count{0};
    return std::filesystem::temp_directory_path() / fmt::format("tactus_{}_{}_{}", ::getpid(), ++count, name);
}

std::string edited(std::uint64_t seed) {
    const Random random{mix(seed)};
    std::uint64_t draws = 0;
    const auto chance = [&](double p) { return random.uniform(draws++) < p; };
    PatchText patch;
    patch.extra = "seed = 7";
    patch.nodes = {{"a", "chaos", "1 kHz", {}},
                   {"b", "chaos", "1 kHz", {}},
                   {"slow", "chaos", "60 Hz", {}},
                   {"voice", "chaos_signal", "48 kHz", {}},
                   {"loud", "gain", "48 kHz", {}}};
    patch.wires = {"voice.signal -> loud.in", "a.out -> voice.glide as linear", "b.out -> loud.factor"};
    // A node that now and then changes rate, and so group, and one with a parameter.
    const bool has_grip = chance(0.7);
    if (has_grip) patch.nodes.push_back({"grip", "chaos", chance(0.5) ? "150 Hz" : "60 Hz", {}});
    const bool has_path = chance(0.6);
    if (has_path) patch.nodes.push_back({"path", "batch_sum", "60 Hz", {}});
    if (chance(0.5)) patch.nodes[0].settings.emplace_back("gain", fmt::format("{:.3f}", random.uniform(draws++)));
    for (int extra = 0; extra < 3; ++extra)
        if (chance(0.3)) {
            const std::string name = fmt::format("extra{}", extra);
            patch.nodes.push_back({name, "chaos", chance(0.5) ? "1 kHz" : "200 Hz", {}});
            patch.wires.push_back("a.out -> " + name + ".in");
        }
    const auto maybe = [&](const std::string& wire) {
        if (chance(0.6)) patch.wires.push_back(wire);
    };
    maybe("a.out -> b.in");
    maybe(chance(0.5) ? "b.out -> a.other as delay 2" : "b.out -> a.other as delay 5");
    maybe("slow.out -> a.in as linear");
    maybe("a.out -> slow.in");
    maybe("voice.level -> slow.gain");
    if (has_grip) {
        maybe("grip.out -> b.other");
        maybe("b.out -> grip.in");
        maybe("grip.out -> voice.held");
    }
    if (has_path) {
        patch.wires.push_back("b.pose -> path.path as batch");
        maybe("loud.out -> path.sound as batch");
        maybe("path.sum -> slow.other");
    }
    return patch.toml();
}

}  // namespace tactus::test
