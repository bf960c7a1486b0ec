// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string wires(std::string_view list) { return "wires = [" + std::string(list) + "]\n"; }

const std::string source_and_relay = a_node("s", "source") + a_node("r", "relay");

}  // namespace

//  ┌───┐   ┌───┐   ┌───┐
//  │ c ├──►│ b ├──►│ a │
//  └───┘   └───┘   └───┘
TEST_CASE("nodes run in the order values flow, whatever their names") {
    const Compiled c = compiled(wires("\"c.value -> b.in\", \"b.out -> a.in\"") + a_node("a", "relay") +
                                a_node("b", "relay") + a_node("c", "source"));
    INFO(c.said);
    REQUIRE(c.plan);
    CHECK(order_of(*c.plan, 0) == "c b a");
}

//  ┌───┐   ┌───┐
//  │ s ├┬─►│ z │
//  └───┘│  ├───┤
//       └─►│ m │    b stands alone
//          └───┘
TEST_CASE("nodes that could run in any order run by name") {
    const Compiled c = compiled(wires("\"s.value -> z.in\", \"s.value -> m.in\"") + a_node("z", "relay") +
                                a_node("s", "source") + a_node("m", "relay") + a_node("b", "source"));
    REQUIRE(c.plan);
    CHECK(order_of(*c.plan, 0) == "b s m z");
}

//       ┌───────────────┐
//  ┌───┐└►┌───┐   ┌───┐ │
//  │ s ├─►│ x ├──►│ y ├─┘
//  └───┘  └───┘   └───┘
TEST_CASE("a cycle is refused with its path, a delay opens it") {
    const std::string nodes = a_node("a", "relay") + a_node("s", "source") + a_node("x", "sum") + a_node("y", "relay");
    const std::string before = "\"s.value -> x.a\", \"x.out -> y.in\", \"y.out -> a.in\", ";
    const Compiled closed = compiled(wires(before + "\"y.out -> x.b\"") + nodes);
    CHECK_FALSE(closed.plan);
    // The node behind the cycle, though first in the file, is not on its path.
    CHECK(closed.said == "p.toml:11:8: a cycle without a delay: y -> x -> y; write 'as delay 1' on one of its wires\n");
    const Compiled open = compiled(wires(before + "\"y.out -> x.b as delay 1\"") + nodes);
    INFO(open.said);
    REQUIRE(open.plan);
    CHECK(order_of(*open.plan, 0) == "s x y a");
}

//   ┌──────┐
//  ┌┴──┐   │
//  │ x │◄──┘
//  └───┘
TEST_CASE("a node wired to itself is a cycle") {
    CHECK_THAT(compiled(wires("\"x.out -> x.in\"") + a_node("x", "relay")).said,
               ContainsSubstring("p.toml:2:8: a cycle") && ContainsSubstring("x -> x;"));
}

//  1 kHz ┌───┐   60 Hz ┌───┐
//        │ x ├────────►│ y │
//        └─▲─┘         └─┬─┘
//          └─────────────┘
TEST_CASE("a loop through two groups needs no delay") {
    const Compiled c =
        compiled(wires("\"x.out -> y.in\", \"y.out -> x.in\"") + a_node("x", "relay") + a_node("y", "relay", "60 Hz"));
    INFO(c.said);
    REQUIRE(c.plan);
    REQUIRE(c.plan->groups.size() == 2);
    CHECK(c.plan->groups[0].period == patch::parse_rate("1 kHz"));  // fastest first
    CHECK(c.plan->groups[1].latency == patch::parse_rate("60 Hz"));
}

//  ┌───┐   ┌───┐
//  │ s ├──►│ r │    with one slip each
//  └───┘   └───┘
TEST_CASE("an unknown name is refused where it stands, with the nearest") {
    CHECK(compiled(a_node("s", "sorce")).said == "p.toml:2:8: unknown node type 'sorce'; did you mean 'source'?\n");
    CHECK(compiled(a_node("s", "source", "1 kHz", "levl = \"1 N\"\n")).said ==
          "p.toml:4:8: no parameter 'levl' on node 's' of type source; did you mean 'level'?\n");
    CHECK_THAT(compiled(a_node("s", "source", "1 kHz", "level = \"1 Nn\"\n")).said,
               ContainsSubstring("p.toml:4:9: parameter 'level' of node 's'"));
    CHECK_THAT(compiled(a_node("s", "source", "1 kHz", "level = \"1 mm\"\n")).said, ContainsSubstring("p.toml:4:9"));
    CHECK_THAT(compiled(a_node("s", "source", "1 kHz", "level = \"11 N\"\n")).said,
               ContainsSubstring("p.toml:4:9") && ContainsSubstring("10 N"));
    CHECK_THAT(compiled(wires("\"s.valu -> r.in\"") + source_and_relay).said,
               ContainsSubstring("p.toml:1:11: no port 'valu' on node 's'; did you mean 'value'?"));
    CHECK_THAT(compiled(wires("\"s.value -> rr.in\"") + source_and_relay).said,
               ContainsSubstring("p.toml:1:11: no node 'rr'; did you mean 'r'?"));
    CHECK_THAT(compiled(wires("\"bone -> r.in\"") + source_and_relay).said, ContainsSubstring("no asset 'bone'"));
    CHECK_THAT(compiled("[nodes.s]\ntype = \"source\"\ngroup = \"slo\"\n[groups.slow]\nrate = \"1 Hz\"\n").said,
               ContainsSubstring("p.toml:3:9: no group 'slo' in [groups]; did you mean 'slow'?"));
}

TEST_CASE("one faulty wire is one problem") {
    CHECK(compiled(wires("\"s.valu -> r.in\"") + source_and_relay).said ==
          "p.toml:1:11: no port 'valu' on node 's'; did you mean 'value'?\n");
}

TEST_CASE("a wire the wrong way round is told so") {
    CHECK_THAT(compiled(wires("\"r.in -> r.in\"") + source_and_relay).said,
               ContainsSubstring("a wire starts at an output"));
    CHECK_THAT(compiled(wires("\"s.value -> s.value\"") + a_node("s", "source")).said,
               ContainsSubstring("a wire ends at an input"));
}

TEST_CASE("a rate that is not exact is refused at the rate") {
    CHECK_THAT(compiled(a_node("s", "source", "1001 Hz")).said,
               ContainsSubstring("p.toml:3:8: 1001 Hz is not exact") && ContainsSubstring("1000 Hz"));
}

//  ┌───┐ bool     ┌───┐ number
//  │ t ├─────────►│ r │
//  └───┘          └───┘
TEST_CASE("a wire's two ends have one type") {
    CHECK(compiled(wires("\"t.out -> r.in\"") + a_node("t", "truth") + a_node("r", "relay")).said ==
          "p.toml:1:11: 't.out' gives a bool, but 'r.in' takes a number\n");
    CHECK_THAT(compiled(wires("\"t.out -> s.level\"") + a_node("t", "truth") + a_node("s", "source")).said,
               ContainsSubstring("takes a number"));
    CHECK_THAT(compiled(wires("\"t.out -> u.in as linear\"") + a_node("t", "truth") + a_node("u", "truth")).said,
               ContainsSubstring("cannot be interpolated"));
}

//  ┌───┐   ┌───┐
//  │ s ├──►│ r │◄── another
//  └───┘   └───┘
TEST_CASE("an input is fed once, and fed unless optional") {
    CHECK_THAT(compiled(source_and_relay).said,
               ContainsSubstring("p.toml:4:8: input 'in' of node 'r' is not connected"));
    CHECK(compiled(wires("\"s.value -> r.in\",\n\"s.value -> r.in\"") + source_and_relay).said ==
          "p.toml:2:2: input 'in' of node 'r' is already fed by another wire\n");
    CHECK(compiled(wires("\"s.value -> x.a\"") + a_node("s", "source") + a_node("x", "sum")).plan);
}

//  ┌───┐ batch ┌───┐
//  │ s ├──────►│ p │
//  └───┘       └───┘
TEST_CASE("a batch goes to inputs that take one, and only there") {
    const std::string nodes = a_node("s", "source") + a_node("p", "path", "60 Hz");
    CHECK(compiled(wires("\"s.value -> p.values as batch\"") + nodes).plan);
    CHECK_THAT(compiled(wires("\"s.value -> p.values\"") + nodes).said, ContainsSubstring("write 'as batch'"));
    CHECK_THAT(compiled(wires("\"s.value -> r.in as batch\"") + source_and_relay).said,
               ContainsSubstring("takes one value"));
}

//  48 kHz ┌───┐ signal   44.1 kHz ┌───┐
//         │ w ├──────────────────►│ g │
//         └───┘                   └───┘
TEST_CASE("a signal stays in its group") {
    const std::string one = wires("\"w.out -> g.in\"") + a_node("w", "wave", "48 kHz");
    CHECK_THAT(compiled(one + a_node("g", "gain", "44.1 kHz")).said,
               ContainsSubstring("p.toml:1:11: a signal stays in its group"));
    const Compiled c = compiled(one + a_node("g", "gain", "48 kHz"));
    REQUIRE(c.plan);
    CHECK(c.plan->groups[0].has_audio);
    CHECK(c.plan->groups[0].latency == flicks_per_second / 1000);  // the quantum
}

//  ┌───┐        ┌───┐
//  │ s ├─number►│ d │ level or memory
//  └───┘        └───┘
TEST_CASE("a wire drives a parameter once, unless it is structural") {
    const std::string nodes = a_node("s", "source") + a_node("d", "source");
    CHECK(compiled(wires("\"s.value -> d.level\"") + nodes).plan);
    CHECK_THAT(compiled(wires("\"s.value -> d.memory\"") + nodes).said,
               ContainsSubstring("p.toml:1:11") && ContainsSubstring("is structural"));
    CHECK_THAT(compiled(wires("\"s.value -> d.level\",\n\"s.value -> d.level\"") + nodes).said,
               ContainsSubstring("p.toml:2:2") && ContainsSubstring("already driven"));
}

//  n0 ──► n1 ──► … ──► n999
TEST_CASE("a thousand nodes in a row are ordered") {
    std::string list, nodes = a_node("n0", "source");
    for (int i = 1; i < 1000; ++i) {
        const std::string name = "n" + std::to_string(i);
        list += "\"n" + std::to_string(i - 1) + (i == 1 ? ".value" : ".out") + " -> " + name + ".in\",\n";
        nodes += a_node(name, "relay");
    }
    const Compiled c = compiled(wires(list) + nodes);
    INFO(c.said);
    REQUIRE(c.plan);
    CHECK(c.plan->groups[0].order.size() == 1000);
    CHECK(c.plan->groups[0].order.front() == 0);
    CHECK(c.plan->groups[0].order.back() == 999);
}

TEST_CASE("a latency of hours, which wires would keep in memory, is refused with the longest that there is") {
    const auto grouped = [](const std::string& latency) {
        return compiled("[groups.slow]\nrate = \"1 kHz\"\nlatency = \"" + latency +
                        "\"\n[nodes.a]\ntype = \"source\"\ngroup = \"slow\"\n");
    };
    CHECK(grouped("1000 s").plan);
    const Compiled refused = grouped("20 h");
    CHECK_FALSE(refused.plan);
    CHECK(refused.said.find("a latency may be 1000000 ticks of its group at most, here 1000 s, got '20 h'") !=
          std::string::npos);
}

//      ┌────────────────┐ delay 3
//  x ─► a ─► b ─► c     │
//       ▲    └─► d ─────┘──► e    and y ─► x, delayed, against the order of the names
TEST_CASE("a cycle in an audio group stands together, and the source of a delay stands before its target") {
    const auto audio = [](const std::string& name, const std::string& type) { return a_node(name, type, "48 kHz"); };
    const Compiled c = compiled(
        "wires = [\"a.out -> b.in\", \"b.out -> c.in\", \"b.out -> d.in\", \"d.out -> a.in as delay 3\", "
        "\"d.out -> e.in as delay 9\", \"y.out -> x.in as delay 1\"]\n" +
        audio("a", "gain") + audio("b", "gain") + audio("c", "gain") + audio("d", "gain") + audio("e", "gain") +
        audio("x", "gain") + audio("y", "wave"));
    INFO(c.said);
    REQUIRE(c.plan);
    const compile::ScheduleGroup& group = c.plan->groups[0];
    REQUIRE(group.cycles.size() == 1);
    CHECK(group.cycles[0].count == 3);
    CHECK(group.cycles[0].longest == 3);
    const std::string order = order_of(*c.plan, 0);
    INFO(order);
    CHECK(order.find("a b d") != std::string::npos);
    CHECK(order.find('y') < order.find('x'));
    CHECK(order.find('d') < order.find('e'));
    CHECK(order.find('d') < order.find('c'));
}
