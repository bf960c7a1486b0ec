// SPDX-License-Identifier: Apache-2.0
// A force fades when a value that it depends on is overdue, in whichever group that is computed.
#include "engine/build/force_path.hpp"
#include "engine/run/clock_decisions.hpp"
#include "engine/run/group_runtime.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/live_case.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

compile::ScheduleGroup group_at(const char* name, Flicks period) {
    compile::ScheduleGroup group;
    group.name = name;
    group.period = group.latency = period;
    return group;
}

/// A hand of 1 kHz on a spring in the group 'contact', which stands still for `stall` from 0.5 s on. A node 'fast' may lie
/// between them.
struct Stalled {
    std::string stall = "300 ms", rate = "1 kHz";
    bool passes_fast = false;

    std::string toml() const {
        PatchText patch;
        patch.nodes = {{"hand", "device_input", "1 kHz", {{"device", "left"}}},
                       {"out", "device_output", "1 kHz", {{"device", "left"}}}};
        patch.wires = {"hand.pose -> plant.pose"};
        if (passes_fast) {
            patch.nodes.push_back({"fast", "gain", "2 kHz", {}});
            patch.wires.insert(patch.wires.end(), {"plant.wrench -> fast.in", "fast.out -> out.wrench"});
        } else patch.wires.emplace_back("plant.wrench -> out.wrench");
        patch.extra = "[devices.left]\ndriver = \"left\"\n[groups.contact]\nrate = \"" + rate +
                      "\"\n[nodes.plant]\ntype = \"planted\"\ngroup = \"contact\"\nfault = \"stall\"\nat = " +
                      std::to_string(static_cast<int>(0.5 * parse_rate())) + "\nstall = \"" + stall + "\"\n";
        return patch.toml();
    }

private:
    double parse_rate() const { return rate == "1 kHz" ? 1000.0 : 500.0; }
};

struct FeltStall {
    std::int64_t stalled_ns = 0;
    LiveOutcome outcome;
    std::vector<std::string> notices;
    std::vector<io::DeviceFault> faults;
};

/// A live run of `seconds`, in which something happens `at` a time; its log repeats it to the bit.
FeltStall run_stalled(const std::string& toml, double seconds, WatchedHand& hand, double at = 0.5) {
    FeltStall felt;
    const auto acquire = hand.performance.acquire;
    std::optional<DeviceSample> first;
    hand.performance.acquire = [&](std::int64_t count, double elapsed, const Wrench& force) {
        const DeviceSample sample = acquire(count, elapsed, force);
        if (!first) first = sample;
        if (felt.stalled_ns == 0 && hand.logical_s >= at) felt.stalled_ns = steady_now();
        return sample;
    };
    const auto log = scratch("late-values");
    run::EngineOptions options;
    options.seconds = seconds;
    options.live = true;
    run::Engine engine(compile_text(toml), options);
    engine.run_live({.dilate = 1.0, .log = log, .stop = nullptr, .watch = {}});
    hand.performance.acquire = acquire;
    for (const auto& slot : engine.host().devices) felt.faults = slot->guard.faults();
    felt.notices = engine.host().notices;
    const take::TimingLog recorded = take::TimingLog::load(log);
    const std::vector<io::RecordedDevice> devices{{"left", engine.host().devices.at(0)->port.info, *first}};
    for (const int threads : {1, 3}) {
        run::EngineOptions again;
        again.seconds = seconds;
        again.replay = &recorded;
        again.devices = &devices;
        run::Engine replay(compile_text(toml), again);
        replay.render(threads);
        CHECK(replay.port_hashes() == engine.port_hashes());
        CHECK(replay.host().devices.at(0)->guard.faults().size() == felt.faults.size());
    }
    std::filesystem::remove(log);
    return felt;
}

}  // namespace

TEST_CASE("a value of force is overdue after 3 ms or one period, one of the world after 1 s") {
    const Flicks period = 1 * ms;
    run::GroupRuntime hand(group_at("hand", period), 0, 1);
    run::DecisionLog log(0);
    run::ChangeQueue changes;
    const run::PauseWindow pause;
    run::LiveDecisions decisions(log, period, changes, pause);
    const io::DeviceSlot slot;
    for (const Flicks source_period : {ms / 4, ms, 2 * ms, 16 * ms, 250 * ms})
        for (const std::int64_t computed : {0, 1, 7, 1000}) {
            CAPTURE(source_period, computed);
            run::GroupRuntime source(group_at("source", source_period), 1, 1);
            source.start_at(computed);
            const Flicks limit = std::max(3 * ms, source_period);
            const std::vector<build::ValueSource> sources{
                {&source, source_period, limit, control::Fault::late_value, "force"},
                {&source, source_period, flicks_per_second, control::Fault::old_world, "world"}};
            const std::vector<build::ValueSource> world{sources[1]};
            const Flicks due = computed * source_period + source_period;
            const std::int64_t at = ceil_div(due + limit, period), old = ceil_div(due + flicks_per_second, period);
            CHECK(decisions.overdue(slot, sources, at - 1) == -1);
            CHECK(decisions.overdue(slot, sources, at) == 0);
            CHECK(decisions.overdue(slot, world, old - 1) == -1);
            CHECK(decisions.overdue(slot, world, old) == 0);
        }
}

TEST_CASE("the sources of a force are the other groups on its path, those behind an input of the world apart") {
    const std::string toml =
        "wires = [\"hand.pose -> spring.device\", \"place.pose -> spring.object\", \"spring.wrench -> out.wrench\",\n"
        "\"near.out -> place.in\", \"place.out -> ear.in\"]\n"
        "[nodes.hand]\ntype = \"device_input\"\nrate = \"1 kHz\"\ndevice = \"simulated\"\n"
        "[nodes.place]\ntype = \"chaos\"\nrate = \"60 Hz\"\n[nodes.near]\ntype = \"chaos\"\nrate = \"30 Hz\"\n"
        "[nodes.ear]\ntype = \"probe\"\nrate = \"10 Hz\"\n[nodes.spring]\ntype = \"spring\"\nrate = \"500 Hz\"\n"
        "[nodes.out]\ntype = \"device_output\"\nrate = \"1 kHz\"\ndevice = \"simulated\"\n";
    run::EngineOptions options;
    options.seconds = 0.1;
    std::optional<compile::Schedule> plan = compile_text(toml);
    using compile::Criticality;
    std::vector<Criticality> ranks;
    for (const compile::ScheduleGroup& group : plan->groups) ranks.push_back(group.criticality);
    CHECK(ranks == std::vector{Criticality::force_output, Criticality::force_value, Criticality::world_value,
                               Criticality::world_value, Criticality::other});
    CHECK(plan->groups[0].backlog == 0);
    CHECK(plan->groups[1].backlog == 0);
    CHECK(plan->groups[2].backlog > 0);
    run::Engine engine(std::move(*plan), options);
    std::vector<std::pair<std::string, control::Fault>> found;
    for (const auto& group : engine.groups())
        for (const auto& of_device : group->scheduled.front()->sources)
            for (const build::ValueSource& source : of_device) found.emplace_back(source.name, source.fault);
    // Groups first, then wires between groups, but for those to the ear.
    REQUIRE(found.size() == 7);
    std::sort(found.begin() + 3, found.end());
    CHECK(found == std::vector<std::pair<std::string, control::Fault>>{
                       {"node 'spring' of the group '500 Hz'", control::Fault::late_value},
                       {"node 'place' of the group '60 Hz'", control::Fault::old_world},
                       {"node 'near' of the group '30 Hz'", control::Fault::old_world},
                       {"node 'hand' of the group '1 kHz'", control::Fault::unusable_value},
                       {"node 'near' of the group '30 Hz'", control::Fault::unusable_value},
                       {"node 'place' of the group '60 Hz'", control::Fault::unusable_value},
                       {"node 'spring' of the group '500 Hz'", control::Fault::unusable_value}});
}

TEST_CASE("a group on the force path that hangs takes the force away, and the fault names its node",
          "[virtual][slow]") {
    for (const Stalled& what : {Stalled{}, Stalled{"300 ms", "500 Hz", false}, Stalled{"300 ms", "1 kHz", true}}) {
        CAPTURE(what.rate, what.passes_fast);
        const VirtualClock clock;
        WatchedHand& hand = watched_hand("left");
        const FeltStall felt = run_stalled(what.toml(), 0.75, hand);
        REQUIRE(felt.faults.size() == 1);
        CHECK(hand.force_at(felt.stalled_ns) == Approx(2.0));
        CHECK(hand.ms_to_zero(felt.stalled_ns) < prompt_ms);
        CHECK(felt.faults[0].reason == control::Fault::late_value);
        CHECK(felt.faults[0].text().find("'plant' of the group 'contact'") != std::string::npos);
    }
}

TEST_CASE("a group of the world that hangs is noted after 3 periods, and takes the force away after 1 s",
          "[virtual][slow]") {
    const auto text = [](const std::string& stall) {
        return "wires = [\"hand.pose -> spring.device\", \"place.pose -> spring.object\",\n"
               "\"spring.wrench -> out.wrench\", \"hand.pose -> plant.pose\"]\n[devices.left]\ndriver = \"left\"\n"
               "[nodes.hand]\ntype = \"device_input\"\nrate = \"1 kHz\"\n"
               "[nodes.place]\ntype = \"still\"\nrate = \"50 Hz\"\n"
               "[nodes.plant]\ntype = \"planted\"\nrate = \"50 Hz\"\nfault = \"stall\"\nat = 25\nstall = \"" +
               stall +
               "\"\n[nodes.spring]\ntype = \"spring\"\nrate = \"1 kHz\"\nstiffness = \"1 N/mm\"\n"
               "[nodes.out]\ntype = \"device_output\"\nrate = \"1 kHz\"\n";
    };
    for (const bool is_long : {false, true}) {
        CAPTURE(is_long);
        const VirtualClock clock;
        WatchedHand& hand = watched_hand("left");
        const FeltStall felt = run_stalled(text(is_long ? "1.2 s" : "300 ms"), is_long ? 1.75 : 0.9, hand);
        CHECK(std::ranges::any_of(felt.notices, [](const std::string& notice) {
            return notice.find("'place' of the group '50 Hz'") != std::string::npos;
        }));
        if (!is_long) {
            CHECK(felt.faults.empty());
            CHECK(hand.force_at(felt.stalled_ns + 300'000'000) == Approx(2.0));
            continue;
        }
        REQUIRE(felt.faults.size() == 1);
        CHECK(felt.faults[0].reason == control::Fault::old_world);
        CHECK(hand.ms_to_zero(felt.stalled_ns) > 1000.0);
        CHECK(hand.ms_to_zero(felt.stalled_ns) < 1060.0);
    }
}

namespace {

/// A hand of 1 kHz that a spring of 500 Hz presses, a node 'bad' that fails from 1.5 s on, and `wires` from it.
std::string patch_of_faulty(const std::string& rate, const std::string& wires, const std::string& more) {
    return "wires = [\"hand.pose -> spring.device\", \"spring.wrench -> sum.in1\", " + wires +
           "\"sum.out -> out.wrench\"]\n[devices.left]\ndriver = \"left\"\n[nodes]\n"
           "hand = {type = \"device_input\", rate = \"1 kHz\"}\nout = {type = \"device_output\", rate = \"1 kHz\"}\n"
           "sum = {type = \"wrench_sum\", rate = \"1 kHz\"}\nend = {type = \"still\", rate = \"1 kHz\"}\n"
           "spring = {type = \"spring\", rate = \"500 Hz\", stiffness = \"1 N/mm\"}\n"
           "bad = {type = \"faulty\", rate = \"" +
           rate + "\", from = \"1.5 s\"" + more;
}

}  // namespace

// Costly: each way to a value that is not finite, at each rate.
TEST_CASE("a value that is not finite takes the force away when it is computed, at every rate of its group",
          "[virtual][slow]") {
    struct Wrong {
        std::string rate, wires, more = "}\n";
        bool is_force = true;  // it reaches the force
    };
    std::vector<Wrong> all{// A parameter keeps its last value.
                           {"10 Hz", R"("bad.number -> spring.damping", "end.pose -> spring.object", )", "}\n", false},
                           // No force depends on it.
                           {"10 Hz", R"("bad.wrench -> ear.in", "end.pose -> spring.object", )",
                            "}\near = {type = \"probe\", rate = \"20 Hz\"}\n", false},
                           // The way to the force leads over another slow group.
                           {"20 Hz", R"("bad.pose -> far.in", "far.out -> spring.object", )",
                            "}\nfar = {type = \"inverse\", rate = \"10 Hz\"}\n"}};
    for (const char* rate : {"4 Hz", "50 Hz", "250 Hz", "3 kHz"})
        for (const char* wires :
             {R"("bad.pose -> spring.object", )", R"("bad.wrench -> sum.in2", "end.pose -> spring.object", )"})
            all.push_back({rate, wires});
    for (const Wrong& wrong : all) {
        CAPTURE(wrong.rate, wrong.wires);
        const VirtualClock clock;
        WatchedHand& hand = watched_hand("left");
        hand.rest = 1.0;  // values of 4 Hz need half a second
        const FeltStall felt = run_stalled(patch_of_faulty(wrong.rate, wrong.wires, wrong.more), 1.9, hand, 1.5);
        if (!wrong.is_force) {
            CHECK(felt.faults.empty());
            CHECK(hand.force_at(felt.stalled_ns + 300'000'000) > 1.0);
            continue;
        }
        CHECK(hand.force_at(felt.stalled_ns - 1'000'000) > 1.0);
        CHECK(hand.ms_to_zero(felt.stalled_ns) <= 13.0);
        REQUIRE_FALSE(felt.faults.empty());
        if (wrong.rate == "3 kHz") continue;  // it may have arrived in the same tick
        CHECK(felt.faults.front().reason == control::Fault::unusable_value);
        CHECK(felt.faults.front().text().find("'bad' of the group '" + wrong.rate + "'") != std::string::npos);
    }
}

TEST_CASE("a value that was not finite and reached no force takes it away for a while, one that did for good",
          "[virtual][slow]") {
    for (const bool reaches : {false, true}) {
        CAPTURE(reaches);
        const VirtualClock clock;
        WatchedHand& hand = watched_hand("left");
        // A dial leaves out a frame that is none.
        const FeltStall felt = run_stalled(
            reaches ? patch_of_faulty("50 Hz", R"("bad.pose -> spring.object", )", ", until = \"1.54 s\"}\n")
                    : patch_of_faulty("50 Hz",
                                      R"("hand.pose -> dial.pose", "bad.pose -> dial.frame",
                                         "dial.wrench -> sum.in2", "end.pose -> spring.object", )",
                                      ", until = \"1.54 s\"}\ndial = {type = \"dial\", rate = \"1 kHz\"}\n"),
            3.5, hand, 1.5);
        CHECK(hand.force_at(felt.stalled_ns + 20'000'000) == 0.0);
        CHECK(hand.force_at(felt.stalled_ns + 900'000'000) == 0.0);
        CHECK((hand.force_at(felt.stalled_ns + 1'900'000'000) > 1.0) == !reaches);
        CHECK(felt.faults.back().reason == (reaches ? control::Fault::not_finite : control::Fault::unusable_value));
        CHECK(felt.faults.size() == (reaches ? 2 : 1));
    }
}
