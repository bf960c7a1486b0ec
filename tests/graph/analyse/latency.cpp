// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/latency.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

#include <algorithm>
#include <numeric>

using namespace tactus;

namespace {

/// The definition, activation by activation over two hyperperiods.
Flicks counted_age(Flicks consumer, Flicks producer, Flicks latency) {
    Flicks worst = 0;
    for (std::int64_t j = 0; j * consumer < 2 * std::lcm(consumer, producer); ++j)
        worst = std::max(worst, j * consumer - compile::source_index(j, consumer, latency, producer) * producer);
    return worst;
}

std::vector<analyse::PathLatency> paths_of(const std::string& text) {
    const Compiled c = compiled(text);
    INFO(c.said);
    REQUIRE(c.plan);
    return analyse::path_latencies(*c.plan);
}

}  // namespace

TEST_CASE("the worst age is that of the schedule, for every ratio of rates") {
    for (const Flicks consumer : {1, 2, 3, 4, 6, 7, 10, 15})
        for (const Flicks producer : {1, 2, 3, 5, 6, 8, 12})
            for (const Flicks latency : {1, 2, 5, 6, 13}) {
                compile::ScheduleGroup from, to;
                from.period = producer;
                from.latency = latency;
                to.period = consumer;
                CAPTURE(consumer, producer, latency);
                CHECK(analyse::worst_age(from, to, {}) == counted_age(consumer, producer, latency));
            }
}

//  in ──► a ──► out     all at 1 kHz
TEST_CASE("inside a group nothing ages") {
    const auto paths = paths_of("wires = [\"in.out -> a.in\", \"a.out -> out.in\"]\n" + a_node("in", "device_input") +
                                a_node("a", "relay") + a_node("out", "device_output"));
    REQUIRE(paths.size() == 1);
    CHECK(paths[0].latency_ms == 0.0);
    CHECK(paths[0].via == std::vector<std::string>{"in", "a", "out"});
}

//  in ──► a ─2─► out
TEST_CASE("a delay inside a group ages by its ticks") {
    const auto paths = paths_of("wires = [\"in.out -> a.in\", \"a.out -> out.in as delay 2\"]\n" +
                                a_node("in", "device_input") + a_node("a", "relay") + a_node("out", "device_output"));
    REQUIRE(paths.size() == 1);
    CHECK(paths[0].latency_ms == Approx(2.0));
}

//  1 kHz  in ──┐          ┌──► out     ages 1 ms on the way down, 10 ms + 9 ms on the way up
//  100 Hz      └──► slow ─┘
TEST_CASE("a way through a slow group has its wait in both directions") {
    const auto paths =
        paths_of("wires = [\"in.out -> slow.in\", \"slow.out -> out.in\"]\n" + a_node("in", "device_input") +
                 a_node("slow", "relay", "100 Hz") + a_node("out", "device_output"));
    REQUIRE(paths.size() == 1);
    CHECK(paths[0].latency_ms == Approx(1.0 + 10.0 + 9.0));
}

//  in ──► slow (100 Hz) ──► x.b
//   └─────────────────────► x.a ──► out, and in2 ──► out2
TEST_CASE("the quickest of several ways counts, and pairs come by name") {
    const auto paths = paths_of(
        "wires = [\"in.out -> slow.in\", \"slow.out -> x.b\", \"in.out -> x.a\", \"x.out -> out.in\", "
        "\"before.out -> a_sink.in\"]\n" +
        a_node("in", "device_input") + a_node("slow", "relay", "100 Hz") + a_node("x", "sum") +
        a_node("out", "device_output") + a_node("before", "device_input") + a_node("a_sink", "device_output"));
    REQUIRE(paths.size() == 2);
    CHECK(paths[0].from == "before");
    CHECK(paths[0].to == "a_sink");
    CHECK(paths[1].from == "in");
    CHECK(paths[1].latency_ms == 0.0);
    CHECK(paths[1].via == std::vector<std::string>{"in", "x", "out"});
}
