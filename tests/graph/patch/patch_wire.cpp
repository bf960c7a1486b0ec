// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/patch_wire.hpp"
#include "tests/graph/patch_reading.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

patch::PatchWire wire(std::string_view text) { return patch::parse_wire(text, {"p.toml", 3, 10}); }

std::string refusal(std::string_view text) {
    try {
        wire(text);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST_CASE("a wire names both ends and how it delivers") {
    const patch::PatchWire plain = wire("hand.pose -> blade_2.pose");
    CHECK(plain.from_node == "hand");
    CHECK(plain.from_port == "pose");
    CHECK(plain.to_node == "blade_2");
    CHECK(plain.to_port == "pose");
    CHECK(plain.mode == patch::WireMode::hold);
    CHECK_FALSE(plain.mode_given);
    CHECK(plain.where.column == 10);
    CHECK(wire("a.b -> c.d as hold").mode_given);
    CHECK(wire("a.b -> c.d as linear").mode == patch::WireMode::linear);
    CHECK(wire("a.b -> c.d as batch").mode == patch::WireMode::batch);
    CHECK(wire("a.b -> c.d as delay 12").mode == patch::WireMode::delay);
    CHECK(wire("a.b -> c.d as delay 12").delay == 12);
}

TEST_CASE("blanks around a wire's words do not matter") {
    for (const char* text : {"a.b->c.d as batch", "  a.b\t->   c.d  as\tbatch  ", "a.b -> c.d\nas batch"}) {
        const patch::PatchWire w = wire(text);
        CHECK(w.from_node + w.from_port + w.to_node + w.to_port == "abcd");
        CHECK(w.mode == patch::WireMode::batch);
    }
}

TEST_CASE("an asset stands on the left of a wire without a port") {
    CHECK(wire("bone -> blade.bone").from_node == "bone");
    CHECK(wire("bone -> blade.bone").from_port.empty());
    CHECK_THAT(refusal("hand.pose -> blade"),
               ContainsSubstring("p.toml:3:23") && ContainsSubstring("a wire ends at a port"));
}

TEST_CASE("a malformed wire is refused at the word that is wrong") {
    CHECK_THAT(refusal(""), ContainsSubstring("p.toml:3:10") && ContainsSubstring("node.port -> node.port"));
    CHECK_THAT(refusal("   "), ContainsSubstring("a wire reads"));
    CHECK_THAT(refusal("a.b"), ContainsSubstring("a wire reads"));
    CHECK_THAT(refusal("a.b > c.d"), ContainsSubstring("p.toml:3:14"));
    CHECK_THAT(refusal("a.b ->"), ContainsSubstring("a wire reads"));
    CHECK_THAT(refusal("-> c.d"), ContainsSubstring("a wire reads"));
    CHECK_THAT(refusal("a. -> c.d"), ContainsSubstring("p.toml:3:12") && ContainsSubstring("port's name"));
    CHECK_THAT(refusal(".b -> c.d"), ContainsSubstring("p.toml:3:10") && ContainsSubstring("node's name"));
    CHECK_THAT(refusal("a.b -> c.d.e"), ContainsSubstring("p.toml:3:19"));
    CHECK_THAT(refusal("a.b -> c.d batch"), ContainsSubstring("p.toml:3:21") && ContainsSubstring("as batch"));
    CHECK_THAT(refusal("a.b -> c.d as"), ContainsSubstring("p.toml:3:21"));
    CHECK_THAT(refusal("a.b -> c.d as cubic"),
               ContainsSubstring("p.toml:3:24") && ContainsSubstring("hold, linear, batch"));
    CHECK_THAT(refusal("a.b -> c.d as hold 3"),
               ContainsSubstring("p.toml:3:29") && ContainsSubstring("nothing may follow"));
    for (const char* delay : {"", "0", "-1", "1.5", "x", "1x", "9999999", "99999999999999999999"})
        CHECK_THAT(refusal(std::string("a.b -> c.d as delay ") + delay), ContainsSubstring("whole number of ticks"));
}

TEST_CASE("in a file the column of a wire's fault counts from the line's beginning") {
    CHECK_THAT(problems_of("wires = [\"a.b -> c.d as cubic\"]\n"), ContainsSubstring("p.toml:1:25:"));
    CHECK_THAT(problems_of("wires = [\n  'a.b > c.d',\n]\n"), ContainsSubstring("p.toml:2:8:"));
    // Where the text is not written as it reads, the place is that of the text.
    CHECK_THAT(problems_of("wires = [\"\\u0061.b > c.d\"]\n"), ContainsSubstring("p.toml:1:10:"));
    CHECK_THAT(problems_of("wires = [\"\"\"\na.b\n> c.d\"\"\"]\n"), ContainsSubstring("p.toml:1:10:"));
}
