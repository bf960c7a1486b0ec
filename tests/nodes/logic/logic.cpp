// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/times.hpp"

#include <limits>
#include <string>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

/// "..#.": true where there is a '#'; beyond the end the last one.
NodeHarness& feed(NodeHarness& node, const std::string& input, const std::string& pattern) {
    return node.feed<bool>(input, [pattern](std::int64_t k) {
        return pattern[std::min(static_cast<std::size_t>(k), pattern.size() - 1)] == '#';
    });
}

std::string pattern_of(const NodeHarness& node, const std::string& output = "out") {
    std::string text;
    for (const bool value : node.values<bool>(output)) text += value ? '#' : '.';
    return text;
}

std::string run(NodeHarness& node, std::int64_t ticks, const std::string& output = "out") {
    node.prepare();
    node.run(ticks);
    return pattern_of(node, output);
}

std::string combined(const char* type) {
    NodeHarness node(type, {.period = ms});
    feed(node, "a", "..##");
    feed(node, "b", ".#.#");
    return run(node, 4);
}

}  // namespace

TEST_CASE("logic follows its truth table") {
    CHECK(combined("and") == "...#");
    CHECK(combined("or") == ".###");
    CHECK(combined("xor") == ".##.");
    NodeHarness opposite("not", {.period = ms});
    CHECK(run(feed(opposite, "in", ".#"), 2) == "#.");
}

TEST_CASE("a comparison with hysteresis changes back only below the threshold by as much") {
    const std::vector<double> in{0.0, 5.0, 5.1, 4.5, 4.0, 3.9, 4.9, 5.2, std::numeric_limits<double>::quiet_NaN(), 3.0};
    const auto number = [&](std::int64_t k) { return in[static_cast<std::size_t>(k)]; };
    NodeHarness above("compare", {.period = ms});
    above.set("threshold", "5").set("hysteresis", "1").feed<double>("in", number);
    CHECK(run(above, 10) == "..##...##.");
    NodeHarness below("compare", {.period = ms});
    below.set("threshold", "5").set("hysteresis", "0").set("is", "below").feed<double>("in", number);
    CHECK(run(below, 10) == "#..####..#");
}

TEST_CASE("select and gate choose whole values of any type") {
    NodeHarness select("select", {.period = ms, .any = &value::wrench});
    const Wrench a{{1.0, 2.0, 3.0}, {}}, b{{}, {4.0, 5.0, 6.0}};
    feed(select, "which", ".#").feed("a", a).feed("b", b);
    select.prepare();
    select.run(2);
    CHECK(select.values<Wrench>("out")[0].force == a.force);
    CHECK(select.values<Wrench>("out")[1].torque == b.torque);
    NodeHarness gate("gate", {.period = ms, .any = &value::pose});
    feed(gate, "open", "#.").feed("in", Pose{{1.0, 0.0, 0.0}, {}});
    gate.prepare();
    gate.run(2);
    CHECK(gate.values<Pose>("out")[0].position.x == 1.0);
    CHECK(gate.values<Pose>("out")[1].position.x == 0.0);
    CHECK(gate.values<Pose>("out")[1].orientation.w == 1.0);
    NodeHarness sound("gate", {.any = &value::signal});
    sound.feed("open", false).feed("in", 1.0f);
    sound.prepare();
    sound.run(100);
    for (const float sample : sound.values<float>("out")) CHECK(sample == 0.0f);
}

TEST_CASE("sample_and_hold keeps the value of the rise") {
    NodeHarness node("sample_and_hold", {.period = ms});
    feed(node, "trigger", "..##.#").feed<double>("in", [](std::int64_t k) { return 10.0 + static_cast<double>(k); });
    node.prepare();
    node.run(6);
    CHECK(node.values<double>("out") == std::vector<double>{0.0, 0.0, 12.0, 12.0, 12.0, 15.0});
}

TEST_CASE("a latch remembers until it is reset, and the reset wins") {
    NodeHarness node("latch", {.period = ms});
    feed(node, "set", ".#..#.#");
    feed(node, "reset", "...##..");
    CHECK(run(node, 7) == ".##...#");
}

TEST_CASE("edges last one tick") {
    const auto edges = [](const char* on) {
        NodeHarness node("edge", {.period = ms});
        return run(feed(node.set("on", on), "in", "#..##."), 6);
    };
    CHECK(edges("rise") == "#..#..");
    CHECK(edges("fall") == ".#...#");
    CHECK(edges("both") == "##.#.#");
}

TEST_CASE("a counter counts rises, turns and resets") {
    NodeHarness node("counter", {.period = ms});
    node.set("turn", "3").feed<bool>("in", [](std::int64_t k) { return k % 2 == 1; });
    node.feed<bool>("reset", [](std::int64_t k) { return k == 9; });
    node.prepare();
    node.run(12);
    CHECK(node.values<double>("count") == std::vector<double>{0, 1, 1, 2, 2, 0, 0, 1, 1, 0, 0, 1});
}

TEST_CASE("debounce follows what lasts, and only that") {
    NodeHarness node("debounce", {.period = ms});
    node.set("time", "3 ms");
    CHECK(run(feed(node, "in", ".#.##.######..#.."), 20) == "........#########...");
}

TEST_CASE("a timer adds the time in which it ran") {
    NodeHarness node("timer", {.period = flicks_per_second / 1000});
    node.feed<bool>("run", [](std::int64_t k) { return k % 2 == 0; }).feed("reset", false);
    node.prepare();
    node.run(2000);
    CHECK(node.last<double>("time") == 1.0);
}

TEST_CASE("a clock is on time after an hour, at a period that is no whole number of ticks too") {
    const auto count_of = [](const char* period, std::int64_t ticks, std::vector<std::int64_t>* when = nullptr) {
        NodeHarness node("clock", {.period = ms});
        node.set("period", period);
        node.prepare();
        node.run(ticks);
        std::int64_t count = 0, at = 0;
        for (const bool tick : node.values<bool>("out")) {
            if (tick && when) when->push_back(at);
            count += tick;
            ++at;
        }
        return count;
    };
    std::vector<std::int64_t> when;
    CHECK(count_of("10 ms", 1000, &when) == 100);
    for (std::size_t i = 0; i < when.size(); ++i) CHECK(when[i] == static_cast<std::int64_t>(10 * i));
    CHECK(count_of("7.3 ms", 730'000) == 100'000);
    CHECK(count_of("1 ms", 100) == 100);
}

TEST_CASE("a sequencer goes through its list and begins again") {
    NodeHarness node("sequencer", {.period = ms});
    node.set("values", "1, 2.5, -3").feed<bool>("step", [](std::int64_t k) { return k % 2 == 1; });
    node.feed<bool>("reset", [](std::int64_t k) { return k == 10; });
    node.prepare();
    node.run(12);
    CHECK(node.values<double>("value") == std::vector<double>{1, 2.5, 2.5, -3, -3, 1, 1, 2.5, 2.5, -3, 1, 2.5});
    for (const char* wrong : {"", "1 2", "1,,2", "a"}) {
        NodeHarness bad("sequencer", {.period = ms});
        bad.set("values", wrong);
        CHECK_THROWS_AS(bad.prepare(), Error);
    }
}

TEST_CASE("debounce does not count ticks that nobody saw for a value that was seen once") {
    NodeHarness node("debounce", {.period = ms});
    node.set("time", "20 ms");
    node.left_out = [](std::int64_t k) { return k == 5 ? 100 : 0; };
    CHECK(run(feed(node, "in", ".....#.."), 10) == "..........");
    NodeHarness held("debounce", {.period = ms});
    held.set("time", "20 ms");
    held.left_out = [](std::int64_t k) { return k == 6 ? 100 : 0; };
    CHECK(run(feed(held, "in", ".....###"), 8) == "......##");
}
