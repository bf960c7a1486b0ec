// SPDX-License-Identifier: Apache-2.0
// Wires between ends of different units.
#include "graph/compile/units.hpp"

#include "graph/node/node.hpp"
#include "tests/graph/patch_reading.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

#include <string>
#include <vector>

namespace tactus {

namespace {

struct Places {
    static constexpr auto about = "One port of each unit.";
    Out<double> metres{"m", "m"}, newtons{"N", "N"}, hertz{"Hz", "Hz"}, angular{"rad/s", "rad/s"}, per{"1/s", "1/s"};
    Out<double> torque{"N m", "N m"}, energy{"J", "J"}, bare{"a bare number", "1"}, unknown{"anything"};
    Out<double> odd{"N/m^1.5", "N/m^1.5"}, speed{"m/s", "m/s"}, kilohertz{"kHz", "kHz"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Places, metres, newtons, hertz, angular, per, torque, energy, bare, unknown, odd, speed, kilohertz)

struct Takers {
    static constexpr auto about = "One port of each unit.";
    In<double> metres{optional, "m", "m"}, newtons{optional, "N", "N"}, hertz{optional, "Hz", "Hz"};
    In<double> angular{optional, "rad/s", "rad/s"}, per{optional, "1/s", "1/s"}, torque{optional, "N m", "N m"};
    In<double> energy{optional, "J", "J"}, bare{optional, "a bare number", "1"}, unknown{optional, "anything"};
    In<double> odd{optional, "N/m^1.5", "N/m^1.5"}, speed{optional, "m/s", "m/s"};
    Param force{"1 N", "0 N", "9 N", "a force"}, factor{"1", "0", "9", "any number"};
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Takers, metres, newtons, hertz, angular, per, torque, energy, bare, unknown, odd, speed, force, factor)

template <UnitRule rule>
struct Ruled {
    static constexpr auto about = "Two values of one type.";
    static constexpr UnitRule units = rule;
    AnyIn a{optional, "first"}, b{optional, "second"};
    AnyOut out{"result"};
    void process(const Tick&) noexcept {}
};
struct Same : Ruled<UnitRule::same> {};
TACTUS_NODE(Same, a, b, out)
struct Product : Ruled<UnitRule::product> {};
TACTUS_NODE(Product, a, b, out)
struct Quotient : Ruled<UnitRule::quotient> {};
TACTUS_NODE(Quotient, a, b, out)
struct PerSecond : Ruled<UnitRule::rate> {};
TACTUS_NODE(PerSecond, a, b, out)
struct TimesSecond : Ruled<UnitRule::integral> {};
TACTUS_NODE(TimesSecond, a, b, out)

struct Texted {
    static constexpr auto about = "A text says its unit.";
    AnyIn in{optional, "value"};
    AnyOut out{"value"};
    Text unit{"", "of both"};
    std::string unit_of(std::string_view) const { return unit.value; }
    void process(const Tick&) noexcept {}
};
TACTUS_NODE(Texted, in, out, unit)

/// What is said of a patch of these nodes: p gives, t takes, and those of `nodes`.
std::string said_of(const std::string& wires, const std::string& nodes = "") {
    const std::vector<const NodeType*> types{&node_type_Places(),      &node_type_Takers(),   &node_type_Same(),
                                             &node_type_Product(),     &node_type_Quotient(), &node_type_PerSecond(),
                                             &node_type_TimesSecond(), &node_type_Texted()};
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(
        "wires = [" + wires + "]\n" + a_node("p", "places") + a_node("t", "takers") + nodes, "p.toml", problems);
    compile::compile(patch, types, problems);
    return said(problems);
}

const std::string nodes = a_node("s", "same") + a_node("x", "product") + a_node("q", "quotient") +
                          a_node("d", "per_second") + a_node("i", "times_second");

}  // namespace

TEST_CASE("a wire whose ends state different units is refused with both ends and units") {
    CHECK(said_of("\"p.metres -> t.newtons\"") == "p.toml:1:11: 'p.metres' gives m, but 't.newtons' takes N\n");
    CHECK(said_of("\"p.newtons -> t.newtons\",\n  \"p.odd -> t.speed\"") ==
          "p.toml:2:4: 'p.odd' gives N/m^1.5, but 't.speed' takes m/s\n");
    CHECK(said_of("\"p.metres -> t.force\"") == "p.toml:1:11: 'p.metres' gives m, but 't.force' takes N\n");
    CHECK(said_of("\"p.metres -> t.bare\"") == "p.toml:1:11: 'p.metres' gives m, but 't.bare' takes 1\n");
}

TEST_CASE("what states no unit takes any") {
    for (const char* port : {"metres", "newtons", "hertz", "unknown", "odd", "bare"}) {
        CHECK(said_of("\"p." + std::string(port) + " -> t.unknown\"").empty());
        CHECK(said_of("\"p." + std::string(port) + " -> t.factor\"").empty());
        CHECK(said_of("\"p.unknown -> t." + std::string(port) + "\"").empty());
    }
    for (const char* port :
         {"metres", "newtons", "hertz", "angular", "per", "torque", "energy", "bare", "odd", "speed"})
        CHECK(said_of("\"p." + std::string(port) + " -> t." + port + "\"").empty());
    CHECK(said_of("\"p.kilohertz -> t.hertz\"").empty());
}

TEST_CASE("turns per second, angles per second and events per second are three things, torque and energy two") {
    const std::vector<std::string> rates{"hertz", "angular", "per"}, works{"torque", "energy"};
    for (const auto& kinds : {rates, works})
        for (const std::string& from : kinds)
            for (const std::string& to : kinds) {
                INFO(from << " to " << to);
                CHECK(said_of("\"p." + from + " -> t." + to + "\"").empty() == (from == to));
            }
}

TEST_CASE("units pass through nodes that say how") {
    // N + N, m · N, N / m, m per s, N · s
    CHECK(said_of("\"p.newtons -> s.a\", \"p.newtons -> s.b\", \"s.out -> t.newtons\"", nodes).empty());
    CHECK(said_of("\"p.newtons -> s.a\", \"s.out -> t.metres\"", nodes) ==
          "p.toml:1:31: 's.out' gives N, but 't.metres' takes m\n");
    CHECK(said_of("\"p.metres -> x.a\", \"p.newtons -> x.b\", \"x.out -> t.torque\"", nodes).empty());
    CHECK(said_of("\"p.metres -> x.a\", \"p.newtons -> x.b\", \"x.out -> t.energy\"", nodes).empty());
    CHECK_FALSE(said_of("\"p.metres -> x.a\", \"p.newtons -> x.b\", \"x.out -> t.newtons\"", nodes).empty());
    CHECK(said_of("\"p.metres -> x.a\", \"p.unknown -> x.b\", \"x.out -> t.newtons\"", nodes).empty());
    CHECK(said_of("\"p.newtons -> q.a\", \"p.metres -> q.b\", \"q.out -> t.newtons\"", nodes) ==
          "p.toml:1:50: 'q.out' gives N/m, but 't.newtons' takes N\n");
    CHECK(said_of("\"p.metres -> d.a\", \"d.out -> t.speed\"", nodes).empty());
    CHECK_FALSE(said_of("\"p.metres -> d.a\", \"d.out -> t.metres\"", nodes).empty());
    CHECK(said_of("\"p.speed -> i.a\", \"i.out -> t.metres\"", nodes).empty());
}

TEST_CASE("the inputs of a sum have one unit, also in a ring of nodes and whatever the order of wires") {
    CHECK(said_of("\"p.metres -> s.a\", \"p.newtons -> s.b\", \"s.out -> t.unknown\"", nodes) ==
          "p.toml:1:30: 's.b' gets N, but 's.a' gets m: 's' takes one unit\n");
    const std::string two = a_node("s", "same") + a_node("u", "same");
    CHECK(said_of("\"s.out -> u.a\", \"u.out -> s.b as delay 1\", \"p.metres -> s.a\", \"u.out -> t.metres\"", two)
              .empty());
    CHECK(said_of("\"s.out -> u.a\", \"u.out -> s.b as delay 1\", \"p.metres -> s.a\", \"p.newtons -> u.b\"", two) ==
          "p.toml:1:27: 's.b' gets N, but 's.a' gets m: 's' takes one unit\n");
}

TEST_CASE("a text of the node states the unit of its ports") {
    const auto node = [](const std::string& unit) {
        return a_node("e", "texted", "1 kHz", "unit = \"" + unit + "\"\n");
    };
    CHECK(said_of("\"p.metres -> e.in\", \"e.out -> t.metres\"", node("m")).empty());
    CHECK(said_of("\"p.metres -> e.in\", \"e.out -> t.newtons\"", node("")).empty());
    CHECK(said_of("\"p.metres -> e.in\", \"e.out -> t.newtons\"", node("N")) ==
          "p.toml:1:11: 'p.metres' gives m, but 'e.in' takes N\n");
    CHECK_FALSE(said_of("\"p.per -> e.in\"", node("Hz")).empty());
    CHECK(said_of("\"p.per -> e.in\"", node("1/s")).empty());
    // Only `prepare` complains about it.
    CHECK(said_of("\"p.per -> e.in\"", node("florins")).empty());
}

}  // namespace tactus
