// SPDX-License-Identifier: Apache-2.0
// What a hand feels when the patch that makes its force is edited, or a parameter of it is set.
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/engine/watched_hand.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

using namespace tactus;
using namespace tactus::test;

namespace {

std::string on_spring(const std::string& stiffness, const std::string& spring = "spring", const std::string& more = "",
                      const std::string& rate = "1 kHz") {
    PatchText patch;
    add_hand(patch, "left", stiffness, spring, rate);
    patch.extra += more;
    return patch.toml();
}

/// Forces of each tick offline, with a plan that takes over at 300 ms.
std::vector<double> rendered(const std::string& first, const std::string& second, int threads = 1, int block = 0) {
    WatchedHand& hand = watched_hand("left");
    run::EngineOptions options;
    options.seconds = 0.6;
    options.block = block;
    run::Engine engine(compile_text(first), options);
    engine.schedule(compile_text(second), 300 * ms);
    engine.render(threads);
    std::vector<double> forces;
    for (const auto& given : hand.given()) forces.push_back(given.force_N);
    return forces;
}

double largest_step(const std::vector<double>& forces) {
    double largest = 0.0;
    for (std::size_t i = 1; i < forces.size(); ++i) largest = std::max(largest, std::abs(forces[i] - forces[i - 1]));
    return largest;
}

}  // namespace

TEST_CASE("a stiffness that an edit changes comes in over a tenth of a second") {
    // The hand was placed in the body and has put nothing in: the energy cap trusts it with 12 N at rest.
    const std::vector<double> forces = rendered(on_spring("1 N/mm"), on_spring("5 N/mm"));
    REQUIRE(forces.size() == 600);
    CHECK(forces[299] == Approx(2.0));
    CHECK(forces[300] == Approx(2.0 + 0.08));
    CHECK(forces[349] == Approx(2.0 + 50 * 0.08));
    CHECK(forces[398] < 9.95);
    for (std::size_t tick = 399; tick < 600; ++tick) REQUIRE(forces[tick] == 10.0);
    CHECK(largest_step({forces.begin() + 290, forces.end()}) < 0.09);
}

TEST_CASE("a parameter that no force depends on changes at once") {
    const auto text = [](const std::string& number) {
        PatchText patch;
        add_hand(patch, "left");
        patch.nodes.push_back({"free", "constant", "1 kHz", {{"number", number}}});
        patch.nodes.push_back({"keeper", "keeper", "1 kHz", {}});
        patch.wires.emplace_back("free.value -> keeper.number");
        return patch.toml();
    };
    watched_hand("left");
    run::EngineOptions options;
    options.seconds = 0.6;
    run::Engine engine(compile_text(text("1")), options);
    engine.schedule(compile_text(text("5")), 300 * ms);
    engine.render(1);
    REQUIRE(kept_values().size() == 600);
    CHECK(kept_values()[299] == 1.0);
    CHECK(kept_values()[300] == 5.0);
}

TEST_CASE("how a parameter comes in is a matter of the sample's index: threads and blocks cannot change a bit") {
    // The force on the hand depends on sound: its level scales a signal in blocks.
    const auto patch = [](const std::string& level) {
        PatchText text;
        add_hand(text, "left");
        text.nodes.push_back({"tone", "sine", "48 kHz", {{"frequency", "90 Hz"}}});
        text.nodes.push_back({"loud", "gain", "48 kHz", {{"factor", level}}});
        text.nodes.push_back({"level", "envelope", "48 kHz", {}});
        text.wires.insert(text.wires.end(),
                          {"tone.signal -> loud.in", "loud.out -> level.in", "level.level -> left_spring.damping"});
        return text.toml();
    };
    const auto hashes = [&](int threads, int block) {
        watched_hand("left");
        run::EngineOptions options;
        options.seconds = 0.5;
        options.block = block;
        run::Engine engine(compile_text(patch("0.5")), options);
        engine.schedule(compile_text(patch("1")), 201 * ms + 777);
        engine.schedule(compile_text(patch("0.2")), 233 * ms + 13);
        engine.render(threads);
        return engine.port_hashes();
    };
    const auto reference = hashes(1, 1);
    for (const int threads : {1, 3})
        for (const int block : {1, 7, 48, 480}) CHECK(hashes(threads, block) == reference);
}

TEST_CASE("a log that changes a parameter at once is repeated so, and one that lets it come in, too") {
    const auto path = scratch("old-log");
    for (const std::uint32_t activations : {0U, 100U}) {
        WatchedHand& hand = watched_hand("left");
        PatchText patch;
        add_hand(patch, "left");
        patch.nodes.push_back({"keeper", "keeper", "1 kHz", {}});
        patch.wires.emplace_back("left_spring.wrench -> keeper.wrench");
        const std::string text = patch.toml();
        std::uint64_t plan_hash = 0;
        {
            run::EngineOptions options;
            run::Engine engine(compile_text(text), options);
            plan_hash = engine.plan_hash();
        }
        {
            take::TimingLogWriter log(path, plan_hash, 0.6);
            take::TimingRecord record;
            record.kind = take::TimingKind::parameter;
            record.source = activations;
            record.tick = 300;
            log.write(record);
            record = {};
            record.tick = 600;
            log.write(record);
            log.finish();
        }
        const take::TimingLog log = take::TimingLog::load(path);
        run::EngineOptions options;
        options.seconds = 0.6;
        options.replay = &log;
        run::Engine engine(compile_text(text), options);
        engine.schedule_change(0, "left_spring", "stiffness", 8000.0);
        engine.render(1);
        const std::vector<double>& forces = kept_values();
        INFO(activations);
        REQUIRE(forces.size() == 600);
        CHECK(forces[299] == Approx(2.0));
        CHECK(forces[300] == Approx(activations == 0 ? 16.0 : 2.14));
        CHECK(forces[450] == 16.0);
        CHECK(hand.given().empty());
        std::filesystem::remove(path);
    }
}

TEST_CASE("an edit of the force path does not jump, however long the control thread needs for it", "[kernel]") {
    const auto folder = scratch("slow-edit");
    const auto big = scratch("big.bin");
    std::ofstream(big).put('x');
    std::filesystem::resize_file(big, 600'000'000);
    const std::string asset = "[assets]\nbig = \"" + big.string() + "\"\n";
    WatchedHand& hand = watched_hand("left");
    std::int64_t asked = 0;
    bool told = false;
    run::Engine::PortHashes live_hashes;
    {
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 30.0, .live = true});
        run::EngineOptions options;
        options.seconds = 30.0;
        options.live = true;
        options.take = &take;
        run::Engine engine(compile_text(on_spring("1 N/mm")), options);
        std::atomic<bool> stop{false};
        run::LiveOptions live;
        live.stop = &stop;
        live.watch = [&] {
            if (asked == 0 && engine.progress_seconds() > 0.5) {
                asked = steady_now();
                engine.edit([&] { return compile_text(on_spring("8 N/mm", "other", asset)); },
                            [&](const run::EditOutcome& outcome) {
                                CHECK_FALSE(outcome.error);
                                told = true;
                            });
            }
            if (told && engine.is_settled() && steady_now() - asked > 500'000'000) stop = true;
        };
        engine.run_live(live);
        engine.finish();
        live_hashes = engine.port_hashes();
    }
    CHECK(told);
    // The new force is too large to come in while the hand stays where it is.
    CHECK(hand.largest_after(asked) < 2.01);
    CHECK(hand.ms_to_zero(asked) < 1e9);
    const Repetition again = repeat(folder, 2);
    CHECK_FALSE(again.difference);
    CHECK(again.hashes == live_hashes);
    std::filesystem::remove_all(folder);
    std::filesystem::remove(big);
}

/// Sets a stiffness in a live run. How many commits were between the forces of the old value and of the new one.
static std::int64_t commits_on_the_way(const std::filesystem::path& folder, run::Engine::PortHashes& live_hashes) {
    WatchedHand& hand = watched_hand("left");
    bool is_set = false;
    take::TakeWriter take(folder, {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 0.8, .live = true});
    run::EngineOptions options;
    options.seconds = 0.8;
    options.live = true;
    options.take = &take;
    run::Engine engine(compile_text(on_spring("1 N/mm")), options);
    run::LiveOptions live;
    live.watch = [&] {
        if (is_set || engine.progress_seconds() < 0.4) return;
        is_set = true;
        engine.set("left_spring", "stiffness", "8 N/mm");
    };
    engine.run_live(live);
    engine.finish();
    live_hashes = engine.port_hashes();
    CHECK(is_set);
    return std::ranges::count_if(hand.given(),
                                 [](const auto& given) { return given.force_N > 2.5 && given.force_N < 15.5; });
}

TEST_CASE("a stiffness that is set while the patch runs comes in slowly, and the take repeats it", "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("slow-set");
    run::Engine::PortHashes live_hashes;
    // 14 ticks by the limit of the slew.
    CHECK(commits_on_the_way(folder, live_hashes) > 40);
    const Repetition again = repeat(folder, 2);
    CHECK_FALSE(again.difference);
    CHECK(again.hashes == live_hashes);
    std::filesystem::remove_all(folder);
}
