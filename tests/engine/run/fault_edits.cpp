// SPDX-License-Identifier: Apache-2.0
// A fault that no edit clears: a patch that computed a force that is not a number is mended while it runs.
#include "tests/engine/chaos.hpp"
#include "tests/engine/live_case.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <atomic>
#include <functional>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

struct Mending {
    std::string fault = "none", plant = "plant", out = "out", max_force = "20 N", recover = "0";
    bool has_out = true;

    std::string toml() const {
        PatchText patch;
        patch.nodes = {{"hand", "device_input", "1 kHz", {{"device", "left"}}},
                       {plant, "planted", "1 kHz", {{"fault", fault}, {"at", "200"}}}};
        patch.wires = {"hand.pose -> " + plant + ".pose"};
        patch.extra = "[devices.left]\ndriver = \"left\"\n";
        if (has_out) {
            patch.nodes.push_back(
                {out,
                 "device_output",
                 "1 kHz",
                 {{"device", "left"}, {"max_force", max_force}, {"recover_after", "10 ms"}, {"recover", recover}}});
            patch.wires.push_back(plant + ".wrench -> " + out + ".wrench");
        }
        return patch.toml();
    }
};

/// What somebody tries who wants to feel the patch again.
std::vector<Mending> mended(const std::string& fault) {
    std::vector<Mending> all{{.fault = fault}};
    const auto then = [&](const std::function<void(Mending&)>& change) {
        all.push_back(all.back());
        change(all.back());
    };
    then([](Mending& m) { m.fault = "none"; });
    then([](Mending& m) { m.max_force = "5 N"; });
    then([](Mending& m) { m.plant = "other"; });
    then([](Mending& m) { m.recover = "1"; });
    then([](Mending& m) { m.has_out = false; });
    then([](Mending& m) { m.has_out = true, m.out = "later"; });
    return all;
}

struct Felt {
    control::Fault fault = control::Fault::none;
    control::ForceState state = control::ForceState::unknown;
    std::vector<double> largest;  ///< N, after each plan, once the hand had left the spring and pressed again
};

/// Live, and edited as a window edits: each plan when the one before has settled and was felt.
Felt felt_live(const std::string& fault) {
    WatchedHand& hand = watched_hand("left");
    hand.depth = 0.0;
    const std::vector<Mending> plans = mended(fault);
    run::EngineOptions options;
    options.seconds = 60.0;
    options.live = true;
    run::Engine engine(compile_text(plans[0].toml()), options);
    std::atomic<bool> stop{false};
    bool is_edited = true;
    std::int64_t since = 0;
    std::size_t plan = 0;
    Felt felt;
    run::LiveOptions live;
    live.stop = &stop;
    live.watch = [&] {
        if (!is_edited || !engine.is_settled() || engine.progress_seconds() < 0.25) return;
        const std::int64_t now = steady_now();
        if (since == 0) since = now;
        // Also after a plan that drives no device: that is no late tick.
        constexpr double leaves_for = 150.0;
        if (ms_between(since, now) < leaves_for) return;
        if (hand.depth == 0.0) {
            hand.depth = 2e-3;
        } else if (ms_between(since, now) > leaves_for + 350.0) {
            felt.largest.push_back(hand.largest_after(since));
            hand.depth = 0.0;
            since = 0;
            if (++plan == plans.size()) {
                stop = true;
                return;
            }
            is_edited = false;
            engine.edit([&plans, plan] { return compile_text(plans[plan].toml()); },
                        [&](const run::EditOutcome& outcome) {
                            CHECK_FALSE(outcome.error);
                            is_edited = true;
                        });
        }
    };
    engine.run_live(live);
    const io::DeviceSlot& slot = *engine.host().devices.at(0);
    felt.fault = slot.port.fault;
    felt.state = slot.port.state;
    return felt;
}

}  // namespace

TEST_CASE("no edit brings forces back after a force that was not a number", "[virtual]") {
    const VirtualClock clock;
    const std::size_t plans = mended("nan").size();
    Felt felt = felt_live("nan");
    CHECK(felt.fault == control::Fault::not_finite);
    REQUIRE(felt.largest.size() == plans);
    for (const double force : felt.largest) CHECK(force == 0.0);
    CHECK(felt.state == control::ForceState::never);

    // Without the fault each plan that drives the hand is felt.
    felt = felt_live("none");
    REQUIRE(felt.largest.size() == plans);
    CAPTURE(felt.largest);
    CHECK(std::ranges::count_if(felt.largest, [](double f) { return f > 1.9; }) + 1 ==
          static_cast<std::ptrdiff_t>(plans));
}

TEST_CASE("offline no edit brings forces back after a force that was not a number either") {
    for (const std::string fault : {"nan", "none"}) {
        INFO(fault);
        // Leaves the spring around each edit.
        WatchedHand& hand = watched_hand("left");
        const auto rests = [](std::int64_t count) { return count < 20 || (count + 100) % 400 < 200; };
        hand.performance.acquire = [&, count = std::int64_t{0}](std::int64_t, double, const Wrench&) mutable {
            DeviceSample sample;
            sample.counter = ++count;
            sample.valid = true;
            sample.pose.position.z = rests(count) ? 0.0 : -2e-3;
            return sample;
        };
        const std::vector<Mending> plans = mended(fault);
        run::EngineOptions options;
        options.seconds = 0.4 * static_cast<double>(plans.size());
        run::Engine engine(compile_text(plans[0].toml()), options);
        for (std::size_t i = 1; i < plans.size(); ++i)
            engine.schedule(compile_text(plans[i].toml()), static_cast<Flicks>(400 * i) * ms);
        engine.render(1);
        const auto given = hand.given();
        const auto felt =
            std::count_if(given.begin() + 210, given.end(), [](const auto& g) { return g.force_N > 1.9; });
        if (fault == "nan") CHECK(felt == 0);
        else CHECK(felt > 300);
        CHECK(engine.host().devices.at(0)->port.fault ==
              (fault == "nan" ? control::Fault::not_finite : control::Fault::none));
    }
}
