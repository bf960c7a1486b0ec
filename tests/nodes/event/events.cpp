// SPDX-License-Identifier: Apache-2.0
// Nodes that give events and nodes that take them.
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/times.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr double nan_number = std::numeric_limits<double>::quiet_NaN();

struct Given {
    std::int64_t tick;
    Event event;
};

std::vector<Given> given(const NodeHarness& node, const std::string& output = "events") {
    std::vector<Given> all;
    const auto ticks = node.values<Events>(output);
    for (std::size_t k = 0; k < ticks.size(); ++k)
        for (const Event& event : ticks[k].all()) all.push_back({static_cast<std::int64_t>(k), event});
    return all;
}

std::function<double(std::int64_t)> row(std::vector<double> values) {
    return [values = std::move(values)](std::int64_t k) {
        return values[std::min(static_cast<std::size_t>(k), values.size() - 1)];
    };
}

/// "b.e i": what comes in each tick: begin, end, instant; '*' is an end and a begin at once.
NodeHarness& feed_events(NodeHarness& node, const std::string& pattern) {
    return node.feed<Events>("in", [pattern](std::int64_t k) {
        Events events;
        const char c = static_cast<std::size_t>(k) < pattern.size() ? pattern[static_cast<std::size_t>(k)] : '.';
        const auto add = [&](EventKind kind) {
            events.add(make_event(k * ms, event_source("there"), kind, {static_cast<double>(k), -1.0}));
        };
        if (c == 'b') add(EventKind::begin);
        if (c == 'e' || c == '*') add(EventKind::end);
        if (c == '*') add(EventKind::begin);
        if (c == 'i') add(EventKind::instant);
        return events;
    });
}

std::string marks_of(const NodeHarness& node, const std::string& output) {
    std::string text;
    for (const bool value : node.values<bool>(output)) text += value ? '#' : '.';
    return text;
}

}  // namespace

TEST_CASE("a list of events keeps sixteen, and an end takes the place of the newest that is none") {
    Events events;
    for (int i = 0; i < 18; ++i) events.add(make_event(i, 1, EventKind::begin, {}));
    CHECK(events.count == 16);
    CHECK(events.lost == 2);
    events.add(make_event(18, 1, EventKind::end, {}));
    CHECK(events.lost == 3);
    CHECK(events.all()[14].time == 14);
    CHECK(events.all()[15].time == 18);
    events.add(make_event(19, 1, EventKind::end, {}));
    CHECK(events.all()[13].time == 13);
    CHECK(events.all()[14].time == 18);
    CHECK(events.all()[15].time == 19);
    for (int i = 20; i < 40; ++i) events.add(make_event(i, 1, EventKind::end, {}));
    CHECK(events.count == 16);
    CHECK(events.lost == 4 + 20);
    for (const Event& event : events.all()) CHECK(event.kind == EventKind::end);
    Events other;
    other.add_all(events);
    CHECK(other.lost == events.lost);
    other.lose(std::int64_t{1} << 40);
    CHECK(other.lost == std::numeric_limits<std::int32_t>::max());
}

TEST_CASE("whatever NaN a node computes, an event carries the same bits") {
    const double other = std::copysign(nan_number, -1.0);
    Hash one, two;
    Events a, b;
    a.add(make_event(1, 2, EventKind::instant, {nan_number, 1.0, 2.0, 3.0, 4.0}));
    b.add(make_event(1, 2, EventKind::instant, {other, 1.0, 2.0, 3.0, 5.0}));
    CHECK(a.all()[0].count == 4);
    value::event.hash(one, &a);
    value::event.hash(two, &b);
    CHECK(one.value() == two.value());
    b.lose(1);
    Hash three;
    value::event.hash(three, &b);
    CHECK(three.value() != one.value());
}

TEST_CASE("a contact begins and ends at its tick, with speed and depth") {
    NodeHarness node("contact_events", {.period = ms});
    node.set("begin", "1 mm").set("hysteresis", "0.5 mm").disconnect("twist").disconnect("contact");
    node.feed<double>("depth", row({-2e-3, 0.0, 1e-3, 1.5e-3, nan_number, 2.5e-3, 0.8e-3, 0.5e-3, 1.2e-3}));
    node.prepare();
    node.run(9);
    const auto all = given(node);
    REQUIRE(all.size() == 3);
    CHECK(all[0].tick == 3);
    CHECK(all[0].event.time == 3 * ms);
    CHECK(all[0].event.source == event_source("node"));
    CHECK(all[0].event.kind == EventKind::begin);
    CHECK(all[0].event.values[0] == Approx(0.5));  // 0.5 mm in 1 ms
    CHECK(all[0].event.values[1] == Approx(1.5e-3));
    CHECK(all[1].tick == 7);
    CHECK(all[1].event.kind == EventKind::end);
    CHECK(all[1].event.values[0] == Approx(0.3));
    CHECK(all[1].event.values[1] == Approx(2.5e-3));
    CHECK(all[2].tick == 8);
    CHECK(marks_of(node, "in_contact") == "...####.#");
}

TEST_CASE("with a tool's contact a contact begins and ends with it, whatever the depth") {
    NodeHarness node("contact_events", {.period = ms});
    node.disconnect("twist").feed<double>("depth", row({1e-3, 2e-3, 0.0, 0.0, 3e-3, 1e-9, 1e-9, 0.0}));
    node.feed<bool>("contact", [](std::int64_t k) { return k >= 2 && k < 6; });
    node.prepare();
    node.run(8);
    CHECK(marks_of(node, "in_contact") == "..####..");
    REQUIRE(given(node).size() == 2);
    CHECK(given(node)[1].event.values[1] == Approx(3e-3));
}

TEST_CASE("with the tool's velocity the speed of a contact is the tool's") {
    NodeHarness node("contact_events", {.period = ms});
    node.disconnect("contact");
    node.feed<double>("depth", row({0.0, 1e-6})).feed("twist", Twist{{0.03, 0.0, -0.04}, {}});
    node.prepare();
    node.run(2);
    REQUIRE(given(node).size() == 1);
    CHECK(given(node)[0].event.values[0] == Approx(0.05));
}

TEST_CASE("a button's press and release are events, of a device or of a bool") {
    NodeHarness node("button_events", {.period = ms});
    node.feed<bool>("in", [](std::int64_t k) { return k >= 2 && k < 5; });
    node.prepare();
    node.run(8);
    auto all = given(node);
    REQUIRE(all.size() == 2);
    CHECK((all[0].tick == 2 && all[0].event.kind == EventKind::begin));
    CHECK((all[1].tick == 5 && all[1].event.kind == EventKind::end));

    NodeHarness device("button_events", {.period = ms});
    device.disconnect("in").set("number", "1");
    device.device_feed = [](std::int64_t k, DevicePort& port) {
        port.sample.valid = k != 3;
        port.sample.buttons = k >= 2 && k != 3 && k < 5 ? 0b10u : 0b01u;
    };
    device.prepare();
    device.run(8);
    all = given(device);
    // A sample that is not valid releases nothing.
    REQUIRE(all.size() == 2);
    CHECK((all[0].tick == 2 && all[1].tick == 5));
}

TEST_CASE("a threshold gives events with hysteresis, and NaN gives none") {
    NodeHarness node("threshold_events", {.period = ms});
    node.set("threshold", "5").set("hysteresis", "1");
    node.feed<double>("in", row({5.0, 5.1, nan_number, 4.5, 5.2, 4.0, 4.9, 6.0}));
    node.prepare();
    node.run(8);
    const auto all = given(node);
    REQUIRE(all.size() == 3);
    CHECK((all[0].tick == 1 && all[0].event.kind == EventKind::begin && all[0].event.values[0] == 5.1));
    CHECK((all[1].tick == 5 && all[1].event.kind == EventKind::end && all[1].event.values[0] == 4.0));
    CHECK(all[2].tick == 7);
}

TEST_CASE("an onset is found at its sample, once for each burst, in blocks of any length") {
    for (const std::uint64_t partition : {0u, 1u, 2u}) {
        NodeHarness node("onset", {.period = flicks_per_second / 48000, .max_frames = 64});
        node.set("gap", "20 ms").set("threshold", "0.2");
        // Bursts of 10 ms, 100 ms apart, on a hum.
        node.feed<float>("in", [](std::int64_t k) {
            const double t = static_cast<double>(k % 4800) / 48000.0;
            const double burst = t < 0.01 ? std::exp(-t / 3e-3) * std::cos(2.0 * 3.14159 * 200.0 * t) : 0.0;
            return static_cast<float>(burst + 0.01 * std::sin(0.1 * static_cast<double>(k)));
        });
        node.prepare();
        node.run(48000, partition);
        const auto all = given(node);
        REQUIRE(all.size() == 10);
        for (std::size_t i = 0; i < 10; ++i) {
            CHECK(all[i].tick == static_cast<std::int64_t>(4800 * i));
            CHECK(all[i].event.time == all[i].tick * flicks_per_second / 48000);
            CHECK(all[i].event.values[0] > 0.9);
        }
    }
}

TEST_CASE("a trigger shows each event as one edge, and its gate is open from a begin to an end") {
    NodeHarness node("event_trigger", {.period = ms});
    feed_events(node, ".b..e.*..iii").prepare();
    node.run(18);
    CHECK(marks_of(node, "trigger") == ".#..#.#.#.#.#.#...");
    CHECK(marks_of(node, "gate") == ".###..############");
    NodeHarness ends("event_trigger", {.period = ms});
    feed_events(ends, ".b..e.*..iii").set("on", "end").prepare();
    ends.run(12);
    CHECK(marks_of(ends, "trigger") == "....#.#.....");
}

TEST_CASE("events are counted by kind, with what was lost") {
    NodeHarness node("event_counter", {.period = ms});
    feed_events(node, "bei*").disconnect("reset").prepare();
    node.run(5);
    CHECK(node.last<double>("count") == 5.0);
    NodeHarness ends("event_counter", {.period = ms});
    feed_events(ends, "bei*").set("on", "end").feed<bool>("reset", [](std::int64_t k) { return k == 1; }).prepare();
    ends.run(5);
    CHECK(ends.last<double>("count") == 1.0);
    NodeHarness lost("event_counter", {.period = ms});
    lost.disconnect("reset").feed<Events>("in", [](std::int64_t) {
        Events events;
        for (int i = 0; i < 20; ++i) events.add({});
        return events;
    });
    lost.prepare();
    lost.run(3);
    CHECK(lost.last<double>("count") == 48.0);
    CHECK(lost.last<double>("lost") == 12.0);
}

TEST_CASE("a number of the last event is kept, and a NaN or a missing number is not") {
    NodeHarness node("event_value", {.period = ms});
    node.set("initial", "7").set("on", "begin");
    node.feed<Events>("in", [](std::int64_t k) {
        Events events;
        if (k == 1) events.add(make_event(ms, 1, EventKind::begin, {3.0}));
        if (k == 2) events.add(make_event(2 * ms, 1, EventKind::begin, {nan_number}));
        if (k == 3) events.add(make_event(3 * ms, 1, EventKind::begin, {}));
        if (k == 4) events.add(make_event(4 * ms, 1, EventKind::end, {9.0}));
        if (k == 5) {
            events.add(make_event(4 * ms, 1, EventKind::begin, {5.0}));
            events.add(make_event(4 * ms, 1, EventKind::begin, {6.0}));
        }
        return events;
    });
    node.prepare();
    node.run(7);
    CHECK(node.values<double>("value") == std::vector<double>{7.0, 3.0, 3.0, 3.0, 3.0, 6.0, 6.0});
    const auto age = node.values<double>("age");
    CHECK(age[0] == 0.0);
    CHECK(age[4] == Approx(1e-3));
    CHECK(age[6] == Approx(2e-3));
}

TEST_CASE("a delay gives each event at the first tick after its time, and ends survive when too many wait") {
    NodeHarness node("event_delay", {.period = ms});
    feed_events(node, "b..e").set("delay", "2.5 ms").prepare();
    node.run(10);
    const auto all = given(node, "out");
    REQUIRE(all.size() == 2);
    CHECK(all[0].tick == 3);
    CHECK(all[0].event.time == 3 * ms);
    CHECK(all[0].event.source == event_source("there"));
    CHECK(all[1].tick == 6);

    NodeHarness full("event_delay", {.period = ms});
    full.set("delay", "100 ms").feed<Events>("in", [](std::int64_t k) {
        Events events;
        for (int i = 0; i < (k < 20 ? 16 : 0); ++i)
            events.add(make_event(k * ms, 1, i == 15 ? EventKind::end : EventKind::instant, {}));
        return events;
    });
    full.prepare();
    full.run(150);
    int ends = 0;
    for (const Given& one : given(full, "out")) ends += one.event.kind == EventKind::end;
    CHECK(given(full, "out").size() == 256);
    CHECK(ends == 20);
    std::int64_t lost = 0;
    for (const Events& events : full.values<Events>("out")) lost += events.lost;
    CHECK(lost == 320 - 256);
}

TEST_CASE("a filter passes the events of one kind or of one node") {
    NodeHarness node("event_filter", {.period = ms});
    feed_events(node, "be*i").set("on", "begin").set("source", "there").prepare();
    node.run(6);
    CHECK(given(node, "out").size() == 2);
    NodeHarness other("event_filter", {.period = ms});
    feed_events(other, "be*i").set("source", "elsewhere").prepare();
    other.run(6);
    CHECK(given(other, "out").empty());
}
