// SPDX-License-Identifier: Apache-2.0
// Calls of audio groups: how long they are, and that nothing depends on it.
#include "engine/take/timing_log.hpp"
#include "nodes/catalogue.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <fmt/format.h>

#include <atomic>
#include <ctime>
#include <filesystem>
#include <utility>

namespace tactus::test {

namespace {

std::atomic<int> calls_seen{0};

}  // namespace

/// Counts its calls.
struct Counted {
    static constexpr auto about = "A signal that counts calls.";
    In<Signal> in{optional, "signal"};
    Out<Signal> out{"signal"};
    void process(const Tick& tick) noexcept {
        ++calls_seen;
        for (int i = 0; i < tick.frames; ++i) out[i] = in[i] + 1.0f;
    }
};
TACTUS_NODE(Counted, in, out)

/// y ← a x + b y', with chaos in it, and a number beside the signal.
struct Loop {
    static constexpr auto about = "A logistic map with feedback.";
    In<Signal> in{optional, "signal"};
    In<Signal> back{optional, "signal"};
    In<double> nudge{optional, "number"};
    Out<Signal> out{"signal"};
    Out<double> level{"number"};
    Param gain{"0.01", "0", "1", "of what comes in"};

    void process(const Tick& tick) noexcept {
        for (int i = 0; i < tick.frames; ++i) {
            const double in_all = std::abs(static_cast<double>(in[i]) + static_cast<double>(back[i]) + nudge);
            x_ = std::clamp(3.9 * x_ * (1.0 - x_) * (1.0 - gain) + gain * std::fmod(in_all, 1.0) * 0.2, 0.01, 0.99);
            out[i] = static_cast<float>(x_);
            level[i] = x_;
        }
    }
    double x_ = 0.3;
};
TACTUS_NODE(Loop, in, back, nudge, out, level, gain)

/// Tells when the value was taken that it reads.
struct Dated {
    static constexpr auto about = "Gives the time of the last value of a batch.";
    Batch<double> in{"number"};
    Out<double> out{"number"};
    void process(const Tick&) noexcept {
        if (in.count > 0) out = seconds(in.times[in.count - 1]) + 0.001 * in.values().back();
    }
};
TACTUS_NODE(Dated, in, out)

namespace {

compile::Schedule plan_of(const PatchText& text) {
    static const std::vector<const NodeType*> types = [] {
        const compile::Catalogue all = chaos_catalogue();
        std::vector<const NodeType*> with(all.begin(), all.end());
        with.push_back(&node_type_Counted());
        with.push_back(&node_type_Loop());
        with.push_back(&node_type_Dated());
        return with;
    }();
    std::string toml = text.toml();
    for (const std::string group : {"\"one\"", "\"two\""})
        for (std::size_t at = 0; (at = toml.find("rate = " + group)) != std::string::npos;)
            toml.replace(at, 4, "group");
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(toml, "test.toml", problems);
    std::optional<compile::Schedule> plan;
    if (problems.empty()) plan = compile::compile(patch, types, problems);
    for (const Error& problem : problems.list) UNSCOPED_INFO(problem.what());
    REQUIRE(problems.empty());
    return std::move(*plan);
}

struct Rendered {
    std::uint64_t hash = 0;
    run::Engine::PortHashes ports;
    int calls = 0;
};

Rendered render(const PatchText& text, int block = 0, bool random = false, int threads = 1, double length = 0.2) {
    run::EngineOptions options;
    options.seconds = length;
    options.block = block;
    options.random_blocks = random;
    calls_seen = 0;
    run::Engine engine(plan_of(text), options);
    engine.render(threads);
    return {engine.output_hash(), engine.port_hashes(), calls_seen};
}

/// Every block gives the bits that blocks of one activation give.
void check_blocks(const PatchText& text) {
    const auto reference = render(text, 1).ports;
    for (const int block : {0, 7, 16, 480})
        for (const bool random : {false, true})
            for (const int threads : {1, 2}) {
                INFO("blocks of " << block << (random ? " at random, " : ", ") << threads << " threads");
                CHECK(render(text, block, random, threads).ports == reference);
            }
}

PatchText feedback(const std::string& delay) {
    return {{{"a", "loop", "48 kHz", {}},
             {"b", "loop", "48 kHz", {}},
             {"c", "loop", "48 kHz", {}},
             {"x", "chaos", "48 kHz", {}},
             {"before", "counted", "48 kHz", {}},
             {"after", "counted", "48 kHz", {}}},
            {"before.out -> a.in", "a.out -> b.in", "b.out -> a.back as delay " + delay, "b.level -> x.in",
             "x.out -> a.gain as delay " + delay, "b.out -> c.in", "c.out -> after.in"},
            "seed = 7"};
}

}  // namespace

TEST_CASE("only the nodes of a cycle run sample by sample, the others a whole call at once") {
    const Rendered whole = render(feedback("1"));
    // Two counted nodes in calls of 48 samples: 400 for 0.2 s.
    CHECK(whole.calls == 400);
    CHECK(render(feedback("1"), 1).calls == 2 * 9600);
}

TEST_CASE("feedback gives the same bits whatever the blocks, for signals, numbers and parameters") {
    for (const char* delay : {"1", "5", "48", "100"}) {
        INFO("delay " << delay);
        check_blocks(feedback(delay));
    }
}

TEST_CASE("a value that a node of a cycle reads with its time has the time of its activation, whatever the blocks") {
    for (const char* delay : {"1", "5", "7"}) {
        INFO("delay " << delay);
        check_blocks({{{"a", "loop", "48 kHz", {}}, {"dated", "dated", "48 kHz", {}}},
                      {"a.level -> dated.in as batch", std::string("dated.out -> a.nudge as delay ") + delay},
                      "seed = 7"});
    }
}

//  Feedback of a node into itself, two cycles, and a delay that closes none, against the order of the names.
TEST_CASE("cycles beside each other and delays without a cycle give the same bits whatever the blocks") {
    check_blocks({{{"z", "loop", "48 kHz", {}},
                   {"m", "loop", "48 kHz", {}},
                   {"a", "loop", "48 kHz", {}},
                   {"b", "loop", "48 kHz", {}},
                   {"slow", "chaos", "1 kHz", {}}},
                  {"z.out -> z.back as delay 1", "z.out -> a.in as delay 3", "a.out -> m.in",
                   "m.out -> a.back as delay 2", "m.level -> b.gain as delay 60", "m.out -> b.in", "b.level -> slow.in",
                   "slow.out -> m.gain as linear", "slow.out -> z.nudge"},
                  "seed = 3"});
}

TEST_CASE("a delayed number drives the parameter of a node in its group") {
    PatchText text{
        {{"a", "chaos", "1 kHz", {}}, {"b", "chaos", "1 kHz", {}}}, {"a.out -> b.gain as delay 2"}, "seed = 7"};
    const auto driven = render(text).ports;
    text.wires.clear();
    CHECK(render(text).ports != driven);
}

TEST_CASE("a number between two audio groups leaves their calls as long as they are") {
    const PatchText text{{{"a", "loop", "one", {}},
                          {"fast", "counted", "one", {}},
                          {"b", "loop", "two", {}},
                          {"far", "counted", "two", {}}},
                         {"a.level -> b.nudge", "a.level -> b.gain as linear", "b.level -> a.nudge"},
                         "seed = 7\n[groups.one]\nrate = \"48 kHz\"\n[groups.two]\nrate = \"48 kHz\"\n"};
    CHECK(render(text).calls == 2 * 200);
    check_blocks(text);
}

TEST_CASE("values between audio groups of different rates give the same bits whatever the blocks") {
    check_blocks({{{"a", "loop", "48 kHz", {}},
                   {"b", "loop", "44.1 kHz", {}},
                   {"quick", "chaos", "20 kHz", {}},
                   {"sum", "batch_sum", "44.1 kHz", {}}},
                  {"a.level -> b.nudge", "b.level -> a.nudge as linear", "quick.out -> a.gain",
                   "quick.pose -> sum.path as batch", "a.out -> sum.sound as batch", "sum.sum -> quick.in"},
                  "seed = 7"});
}

TEST_CASE("a hand in an audio group is sampled at every activation, whatever the blocks") {
    PatchText text{{{"hand", "device_input", "48 kHz", {}},
                    {"spring", "planted", "48 kHz", {}},
                    {"out", "device_output", "48 kHz", {}},
                    {"tone", "counted", "48 kHz", {}}},
                   {"hand.pose -> spring.pose", "spring.wrench -> out.wrench"},
                   "seed = 7\n[devices.one]\ndriver = \"simulated\"\n"};
    check_blocks(text);
}

TEST_CASE("groups that tick faster than the system wakes a thread leave most of the processor to others", "[live]") {
    const auto processor_ns = [] {
        timespec t;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
        return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
    };
    run::EngineOptions options;
    options.seconds = 0.5;
    options.live = true;
    run::Engine engine(plan_of({{{"a", "chaos", "16 kHz", {}}}, {}, "seed = 7"}), options);
    const auto before = processor_ns();
    engine.run_live({});
    // A thread that never slept would take all of the half second.
    CHECK(processor_ns() - before < 350'000'000);
}

TEST_CASE("what came too late between two audio groups is repeated from the log, whatever blocks and threads",
          "[virtual][slow]") {
    // Repeated in virtual time, too, so that the threads of a repetition meet in every order.
    const VirtualClock clock;
    const PatchText text{{{"a", "loop", "one", {}},
                          {"x", "chaos", "one", {}},
                          {"b", "loop", "two", {}},
                          {"y", "chaos", "two", {}},
                          {"quick", "chaos", "20 kHz", {}},
                          {"sum", "batch_sum", "two", {}},
                          {"p", "planted", "one", {{"fault", "stall"}, {"stall", "30 ms"}, {"at", "3000"}}},
                          {"q", "planted", "two", {{"fault", "stall"}, {"stall", "40 ms"}, {"at", "9000"}}}},
                         {"a.level -> b.nudge", "x.out -> b.gain as linear", "b.level -> a.nudge", "y.out -> x.in",
                          "quick.out -> y.other", "quick.pose -> sum.path as batch", "sum.sum -> a.gain",
                          "x.pose -> p.pose", "y.pose -> q.pose"},
                         "seed = 7\n[groups.one]\nrate = \"48 kHz\"\nlatency = \"0.3 ms\"\n"
                         "[groups.two]\nrate = \"44.1 kHz\"\n"};
    const auto log = scratch("parts.log");
    run::EngineOptions options;
    options.seconds = 0.3;
    options.live = true;
    run::Engine live(plan_of(text), options);
    live.run_live({.dilate = 1.0, .log = log, .stop = nullptr, .watch = {}});
    std::int64_t late = 0;
    for (const auto& group : live.groups()) late += group->telemetry.misses + group->telemetry.skipped;
    CHECK(late > 0);
    check_replays([&] { return plan_of(text); }, options.seconds, log, live.port_hashes());
    std::filesystem::remove(log);
}

TEST_CASE("a log in which two groups wait for each other ends the repetition with an error, on any number of threads") {
    const PatchText text{
        {{"a", "chaos", "1 kHz", {}}, {"b", "chaos", "500 Hz", {}}}, {"a.out -> b.in", "b.out -> a.in"}, "seed = 7\n"};
    const auto path = scratch("stands.log");
    {
        const run::Engine engine(plan_of(text), {});
        take::TimingLogWriter writer(path, engine.plan_hash(), 0.1);
        // At 20 ms each reads what the other gives later.
        for (const auto& [group, tick] : {std::pair{0, 20}, std::pair{1, 10}})
            for (const std::uint32_t link : {0u, 1u}) {
                take::TimingRecord record;
                record.kind = take::TimingKind::held_read;
                record.group = static_cast<std::uint16_t>(group);
                record.source = link;
                record.tick = tick;
                record.count = 1;
                record.value = 25;
                writer.write(record);
            }
        writer.finish();
    }
    const take::TimingLog recorded = take::TimingLog::load(path);
    for (const int threads : {1, 2}) {
        run::EngineOptions options;
        options.seconds = 0.1;
        options.replay = &recorded;
        run::Engine replay(plan_of(text), options);
        using Catch::Matchers::ContainsSubstring;
        CHECK_THROWS_WITH(replay.render(threads),
                          ContainsSubstring("cannot be repeated: every group waits for another") &&
                              ContainsSubstring("at 0.0200 s") && ContainsSubstring("does not fit the patch"));
    }
    std::filesystem::remove(path);
}

}  // namespace tactus::test
