// SPDX-License-Identifier: Apache-2.0
// What every node type of the catalogue must keep, whatever it computes.
#include "graph/compile/units.hpp"
#include "nodes/catalogue.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/realtime_check.hpp"

using namespace tactus;
using test::Feed;
using test::NodeHarness;

namespace {

/// The types that an input of any type is tried with.
std::vector<const ValueType*> wires_of(const NodeType& type) {
    NodeHarness probe(type);
    if (probe.takes() == 0) return {&value::number};
    std::vector<const ValueType*> types;
    for (const ValueType* any : value::plain_types())
        if (probe.takes() & kind_of(*any)) types.push_back(any);
    return types;
}

template <class Check>
void for_every_node(Check&& check) {
    for (const NodeType* type : nodes::catalogue())
        for (const ValueType* any : wires_of(*type)) {
            INFO(type->name << " on a wire of " << any->name);
            check(*type, any);
        }
}

/// A hand of the feed jumps through the whole bone from tick to tick: carving it with 27 times the voxels would take nine
/// tenths of the time of all nodes.
void prepare(NodeHarness& harness, const NodeType& type) {
    if (type.name == "carve") harness.set("kerf", "3 mm").asset("source", test::coarse_ball());
    harness.prepare();
}

std::uint64_t hash_of(const NodeType& type, const ValueType* any, Feed feed, std::uint64_t partition) {
    NodeHarness harness(type, {.max_frames = 17, .feed = feed, .drive_params = true, .any = any});
    prepare(harness, type);
    harness.run(2000, partition);
    return harness.output_hash();
}

struct Declaration final : MemberVisitor {
    void input(std::string_view name, Input& port) override {
        require(name, port.about);
        if (port.type) check_unit(name, *port.type, port.unit);
    }
    void output(std::string_view name, Output& port) override {
        require(name, port.about);
        check_unit(name, *port.type, port.unit);
    }
    void param(std::string_view name, Param& p) override {
        require(name, p.about);
        CHECK(name != "rate");
        INFO(name << " = " << p.value << " in " << p.min << " … " << p.max);
        CHECK(p.min < p.max);
        CHECK(p.value >= p.min);
        CHECK(p.value <= p.max);
    }
    void choice(std::string_view name, Choice& c) override {
        require(name, c.about);
        CHECK(c.options.size() > 1);
    }
    void text(std::string_view name, Text& t) override { require(name, t.about); }
    void flag(std::string_view name, Flag& f) override { require(name, f.about); }
    void vector(std::string_view name, Vector& v) override { require(name, v.about); }
    void asset(std::string_view name, AssetParam& a) override { require(name, a.about); }

    /// One that cannot be read would stop every patch with the node.
    static void check_unit(std::string_view name, const ValueType& type, const char* unit) {
        INFO("member " << name << " in " << unit);
        if (&type == &value::number || &type == &value::signal || &type == &value::vector)
            CHECK_NOTHROW(compile::stated_unit(unit));
        if (&type == &value::event || &type == &value::boolean) CHECK(std::string_view(unit).empty());
    }

    /// The keys type, rate and group of a node say what it is and when it runs; a port may still be called rate.
    static void require(std::string_view name, std::string_view about) {
        INFO("member " << name);
        CHECK_FALSE(about.empty());
        CHECK(name != "type");
        CHECK(name != "group");
    }
};

void check_partitions(Feed feed, std::initializer_list<std::uint64_t> partitions) {
    for_every_node([&](const NodeType& type, const ValueType* any) {
        const std::uint64_t whole = hash_of(type, any, feed, 0);
        for (const std::uint64_t partition : partitions) CHECK(hash_of(type, any, feed, partition) == whole);
    });
}

}  // namespace

// Costly: every node twice.
TEST_CASE("a partition of a run into random blocks gives the same bits", "[slow]") {
    check_partitions(Feed::ordinary, {3});
}

// Costly: every node twice.
TEST_CASE("a partition of a run into random blocks gives the same bits, also of hostile values", "[slow]") {
    check_partitions(Feed::hostile, {2});
}

TEST_CASE("any partition of a run into blocks gives the same bits, also of hostile values", "[long]") {
    for (const Feed feed : {Feed::ordinary, Feed::hostile}) check_partitions(feed, {0, 1, 2, 3});
}

TEST_CASE("finite values in give finite values out", "[slow]") {
    for_every_node([](const NodeType& type, const ValueType* any) {
        NodeHarness harness(type, {.drive_params = true, .any = any});
        prepare(harness, type);
        harness.run(3000);
        CHECK(harness.finite());
    });
}

TEST_CASE("a node recovers from values that are not finite, huge or denormal", "[slow]") {
    for_every_node([](const NodeType& type, const ValueType* any) {
        NodeHarness harness(type, {.feed = Feed::hostile, .any = any});
        prepare(harness, type);
        harness.run(3000);
        harness.feed_with(Feed::ordinary);
        harness.run(3000);
        harness.forget();
        harness.run(3000);
        CHECK(harness.finite());
    });
}

TEST_CASE("a tick of a node allocates nothing, takes no lock and calls no system", "[slow]") {
    for_every_node([](const NodeType& type, const ValueType* any) {
        for (const Feed feed : {Feed::ordinary, Feed::hostile}) {
            NodeHarness harness(type, {.feed = feed, .drive_params = true, .any = any});
            prepare(harness, type);
            const RealtimeViolations seen = watch_scopes([&] { harness.run(500, 1); });
            INFO(seen.describe());
            CHECK(seen.none());
        }
    });
}

TEST_CASE("a node runs with every optional input left open", "[slow]") {
    for_every_node([](const NodeType& type, const ValueType* any) {
        NodeHarness harness(type, {.any = any});
        harness.disconnect_optional();
        prepare(harness, type);
        harness.run(500);
        CHECK(harness.finite());
    });
}

TEST_CASE("every member is explained and every default lies in its range") {
    for (const NodeType* type : nodes::catalogue()) {
        INFO(type->name);
        CHECK_FALSE(type->about.empty());
        void* node = type->create();
        Declaration declaration;
        type->visit(node, declaration);
        type->destroy(node);
    }
}
