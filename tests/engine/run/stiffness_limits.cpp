// SPDX-License-Identifier: Apache-2.0
// Whoever makes a plan run: it feels no stiffer than its devices state.
#include "graph/analyse/stiffness.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/engine/watched_hand.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <filesystem>

using namespace tactus;
using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr double stated = 5e3;  // N/m

/// A hand on a spring, behind a workspace of that scale.
std::string scaled(const std::string& stiffness, const std::string& scale) {
    PatchText patch;
    add_hand(patch, "left", stiffness);
    patch.nodes.push_back({"room", "workspace", "1 kHz", {{"scale", scale}}});
    patch.wires.front() = "left_hand.pose -> room.device";
    patch.wires.emplace_back("room.pose -> left_spring.device");
    return patch.toml();
}

void state_stiffness() { watched_hand("left").performance.info.max_stiffness = stated; }

const Param& spring_of(const run::Engine& engine) {
    for (const auto& node : engine.nodes())
        if (node->name == "left_spring") return *node->params.at("stiffness");
    throw Error("there is no spring");
}

}  // namespace

TEST_CASE("an engine takes no plan that is stiffer than its device states, at the start or by an edit") {
    state_stiffness();
    const auto is_refused = ContainsSubstring("states that it can be 5 N/mm stiff; lower it to 1.25 N/mm");
    CHECK_THROWS_WITH(run::Engine(compile_text(scaled("2 N/mm", "2")), {}), is_refused);
    run::Engine engine(compile_text(scaled("2 N/mm", "1")), {});
    CHECK_THROWS_WITH(engine.schedule(compile_text(scaled("2 N/mm", "2")), 1), is_refused);
    run::EngineOptions judging;
    judging.only_checked = true;
    CHECK_NOTHROW(run::Engine(compile_text(scaled("2 N/mm", "2")), judging));
}

TEST_CASE("an edit that opens a device is judged by what that device states") {
    state_stiffness();
    watched_hand("right").performance.info.max_stiffness = 1e3;
    const auto with_right = [](const std::string& stiffness) {
        PatchText patch;
        add_hand(patch, "left");
        add_hand(patch, "right", stiffness);
        return patch.toml();
    };
    PatchText patch;
    add_hand(patch, "left");
    run::Engine engine(compile_text(patch.toml()), {});
    CHECK_THROWS_WITH(engine.schedule(compile_text(with_right("2 N/mm")), 1), ContainsSubstring("lower it to 1 N/mm"));
    CHECK_NOTHROW(engine.schedule(compile_text(with_right("0.9 N/mm")), 1));
}

TEST_CASE("an edit that makes a stiffness be felt more lowers one that was set while the patch ran", "[virtual]") {
    const VirtualClock clock;
    state_stiffness();
    const auto folder = scratch("limit-edit");
    run::Engine::PortHashes live_hashes;
    {
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 30.0, .live = true});
        run::EngineOptions options;
        options.seconds = 30.0;
        options.live = true;
        options.take = &take;
        run::Engine engine(compile_text(scaled("1 N/mm", "1")), options);
        std::atomic<bool> stop{false};
        run::LiveOptions live;
        live.stop = &stop;
        int step = 0;
        double edited_s = 1e9;
        live.watch = [&] {
            const double at = engine.progress_seconds();
            if (step == 0 && at > 0.2) {
                engine.set("left_spring", "stiffness", "4 N/mm");
                step = 1;
            } else if (step == 1 && at > 0.4) {
                engine.edit([&] { return compile_text(scaled("1 N/mm", "2")); },
                            [&](const run::EditOutcome& outcome) {
                                CHECK_FALSE(outcome.error);
                                edited_s = seconds(outcome.when);
                            });
                step = 2;
            } else if (step == 2 && at > edited_s + 0.3) {
                CHECK_THROWS_WITH(engine.set("left_spring", "stiffness", "2 N/mm"), ContainsSubstring("1.25 N/mm"));
                stop = true;
            }
        };
        engine.run_live(live);
        engine.finish();
        CHECK(spring_of(engine).max == stated / 4.0);
        CHECK(spring_of(engine).value == stated / 4.0);
        live_hashes = engine.port_hashes();
    }
    const Repetition again = repeat(folder, 2);
    CHECK_FALSE(again.difference);
    CHECK(again.hashes == live_hashes);
    std::filesystem::remove_all(folder);
}

TEST_CASE("the nodes of a plan can be asked for their units and slopes once it runs") {
    run::EngineOptions options;
    options.seconds = 0.01;
    const PatchText patch{
        {{"x", "chaos", "1 kHz", {}}, {"law", "gain", "1 kHz", {{"unit", "N"}}}}, {"x.out -> law.in"}, ""};
    run::Engine engine(compile_text(patch.toml()), options);
    engine.render(1);
    CHECK(analyse::unstated_laws(engine.plan()).empty());
    CHECK(analyse::force_loops(engine.plan(), [](const std::string&) {
              return DeviceInfo{.name = {}, .damping = 1.0};
          }).empty());
}
