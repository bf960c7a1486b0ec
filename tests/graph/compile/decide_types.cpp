// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

const ValueType* type_of(const compile::Schedule& plan, std::string_view name) {
    for (const compile::ScheduleNode& node : plan.nodes)
        if (node.name == name) return node.outputs.front().port->type;
    return nullptr;
}

std::string wires_of(std::string_view list) { return "wires = [" + std::string(list) + "]\n"; }

}  // namespace

TEST_CASE("a type travels through nodes of open type, in whatever order the wires are written") {
    const Compiled c = compiled(wires_of("\"r.out -> in.in\", \"q.out -> r.a\", \"p.out -> q.a\", \"s.value -> p.a\"") +
                                a_node("s", "source") + a_node("p", "pair") + a_node("q", "pair") +
                                a_node("r", "pair") + a_node("in", "relay"));
    INFO(c.said);
    REQUIRE(c.plan);
    CHECK(type_of(*c.plan, "p") == &value::number);
    CHECK(type_of(*c.plan, "r") == &value::number);
    // The input without a wire has the type too.
    for (const compile::ScheduleNode& node : c.plan->nodes)
        if (node.name == "p") CHECK(node.inputs[1].port->type == &value::number);
}

TEST_CASE("a signal makes its group an audio group through a node of open type") {
    const Compiled c = compiled(wires_of("\"w.out -> p.a\", \"p.out -> g.in\"") + a_node("w", "wave", "48 kHz") +
                                a_node("p", "pair", "48 kHz") + a_node("g", "gain", "48 kHz"));
    INFO(c.said);
    REQUIRE(c.plan);
    CHECK(type_of(*c.plan, "p") == &value::signal);
    CHECK(c.plan->nodes[1].takes_blocks);
}

TEST_CASE("a feedback through a node of open type has the type that comes in from outside") {
    const Compiled c = compiled(wires_of("\"p.out -> q.a\", \"q.out -> p.b as delay 1\", \"s.value -> p.a\"") +
                                a_node("s", "source") + a_node("p", "pair") + a_node("q", "pair"));
    INFO(c.said);
    REQUIRE(c.plan);
    CHECK(type_of(*c.plan, "q") == &value::number);
}

TEST_CASE("two types on one node are refused, and so are types that it does not take") {
    const std::string nodes = a_node("s", "source") + a_node("w", "wave") + a_node("t", "truth") + a_node("p", "pair");
    CHECK_THAT(compiled(wires_of("\"s.value -> p.a\", \"w.out -> p.b\"") + nodes).said,
               ContainsSubstring("'w.out' gives a signal, but 'p.b' takes a number"));
    CHECK_THAT(compiled(wires_of("\"t.out -> p.a\"") + nodes).said,
               ContainsSubstring("'t.out' gives a bool, but 'p.a' takes a number or signal"));
}

TEST_CASE("a cycle that no type comes into is refused as a cycle, and with a delay carries numbers") {
    const std::string nodes = a_node("p", "pair") + a_node("q", "pair");
    CHECK_THAT(compiled(wires_of("\"p.out -> q.a\", \"q.out -> p.a\"") + nodes).said,
               ContainsSubstring("a cycle without a delay"));
    const Compiled c = compiled(wires_of("\"p.out -> q.a\", \"q.out -> p.a as delay 1\"") + nodes);
    INFO(c.said);
    REQUIRE(c.plan);
    CHECK(type_of(*c.plan, "p") == &value::number);
}
