// SPDX-License-Identifier: Apache-2.0
// Every node type of the catalogue in many situations under the watch of the real-time check. A new type is covered by
// standing in the catalogue; its choices and flags are found by asking it.
#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/realtime_check.hpp"

#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using test::Feed;
using test::NodeHarness;

namespace {

/// What there is to set and to connect on a type.
struct Inventory final : MemberVisitor {
    void input(std::string_view, Input& port) override {
        batches += port.kind == InputKind::batch;
        snapshots += port.type && port.type->version;
    }
    void choice(std::string_view name, Choice& c) override {
        for (const std::string& option : c.options) settings.emplace_back(name, option);
    }
    void flag(std::string_view name, Flag& f) override { settings.emplace_back(name, f ? "false" : "true"); }

    std::vector<std::pair<std::string, std::string>> settings;
    int batches = 0, snapshots = 0;
};

Inventory inventory_of(const NodeType& type) {
    Inventory inventory;
    void* node = type.create();
    type.visit(node, inventory);
    type.destroy(node);
    return inventory;
}

/// One way to run a node.
struct Situation {
    Feed feed;
    bool optional_connected, drive_params;
    int max_frames;
};

std::string describe(const Situation& s) {
    return std::string(s.feed == Feed::ordinary ? "ordinary" : "hostile") + " values, optional inputs " +
           (s.optional_connected ? "connected" : "open") + ", parameters " + (s.drive_params ? "driven" : "at rest") +
           ", calls of up to " + std::to_string(s.max_frames);
}

/// The first ticks, those after them, and a change from good to bad input and back. False: the node refuses to be
/// prepared that way.
bool runs_clean(const NodeType& type, const ValueType* any, const Situation& s,
                const std::pair<std::string, std::string>* setting) {
    NodeHarness harness(type, {.max_frames = s.max_frames, .feed = s.feed, .drive_params = s.drive_params, .any = any});
    if (!s.optional_connected) harness.disconnect_optional();
    try {
        if (setting) harness.set(setting->first, setting->second);
        harness.prepare();
    } catch (const Error&) {
        return false;
    }
    const RealtimeViolations seen = watch_scopes([&] {
        harness.run(3);
        harness.run(150, 1);
        harness.feed_with(s.feed == Feed::ordinary ? Feed::hostile : Feed::ordinary);
        harness.run(50, 2);
        harness.feed_with(s.feed);
        harness.run(50, 3);
    });
    INFO(type.name << ", " << describe(s) << (setting ? ", " + setting->first + " = " + setting->second : ""));
    INFO(seen.describe());
    CHECK(seen.none());
    return true;
}

/// Every node in these situations, and with each setting that is not its default.
void watch_all(const std::vector<Situation>& situations) {
    if (const RealtimeWatch watch = realtime_watch(); !watch.missing.empty())
        WARN("skipped in part: " << watch.missing);
    for (const NodeType* type : nodes::catalogue()) {
        std::vector<const ValueType*> wires{&value::number};
        if (const ValueKinds takes = NodeHarness(*type).takes()) {
            wires.clear();
            for (const ValueType* any : value::plain_types())
                if (takes & kind_of(*any)) wires.push_back(any);
        }
        int ran = 0;
        for (const ValueType* any : wires)
            for (const Situation& situation : situations) ran += runs_clean(*type, any, situation, nullptr);
        INFO(type->name);
        CHECK(ran > 0);
        for (const auto& setting : inventory_of(*type).settings)
            runs_clean(*type, wires.front(), {Feed::ordinary, true, true, 64}, &setting);
    }
}

}  // namespace

// Each pair of values of two properties is met once.
// Costly: every node in four situations.
TEST_CASE("every node is real-time safe in its first ticks, open or connected, driven, with good and bad input",
          "[slow]") {
    watch_all({{Feed::ordinary, true, true, 64},
               {Feed::ordinary, false, false, 1},
               {Feed::hostile, true, false, 1},
               {Feed::hostile, false, true, 64}});
}

TEST_CASE("every node is real-time safe in its first ticks in all situations", "[long]") {
    std::vector<Situation> all;
    for (const Feed feed : {Feed::ordinary, Feed::hostile})
        for (const bool connected : {true, false})
            for (const bool driven : {true, false}) all.push_back({feed, connected, driven, driven ? 64 : 1});
    watch_all(all);
}

TEST_CASE("the walk meets batches and snapshots") {
    int batches = 0, snapshots = 0;
    for (const NodeType* type : nodes::catalogue()) {
        const Inventory inventory = inventory_of(*type);
        batches += inventory.batches;
        snapshots += inventory.snapshots;
    }
    CHECK(batches > 0);
    CHECK(snapshots > 0);
}
