// SPDX-License-Identifier: Apache-2.0
#include "graph/analyse/draw.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string picture_of(const std::string& text) {
    const Compiled c = compiled(text);
    INFO(c.said);
    REQUIRE(c.plan);
    return analyse::draw_svg(*c.plan);
}

}  // namespace

TEST_CASE("the picture names every node, its type and its group") {
    const std::string svg = picture_of("title = \"Two\"\nwires = [\"s.value -> r.in\"]\n" + a_node("s", "source") +
                                       a_node("r", "relay", "60 Hz"));
    CHECK(svg.starts_with("<svg"));
    CHECK(svg.ends_with("</svg>\n"));
    for (const char* part : {">s<", ">source<", ">r<", ">relay<", ">1 kHz<", ">60 Hz<", "latency 16.67 ms"})
        CHECK_THAT(svg, ContainsSubstring(part));
    CHECK_THAT(svg, ContainsSubstring("stroke-dasharray") && ContainsSubstring("hold 1 ms"));
}

TEST_CASE("only wires between groups are dashed") {
    CHECK_THAT(picture_of("wires = [\"s.value -> r.in\"]\n" + a_node("s", "source") + a_node("r", "relay")),
               !ContainsSubstring("stroke-dasharray"));
}

TEST_CASE("what a title says cannot break the picture") {
    CHECK_THAT(picture_of("title = \"<a> & \\\"b\\\"\"\n" + a_node("s", "source")),
               ContainsSubstring("&lt;a&gt; &amp; &quot;b&quot;") && !ContainsSubstring("<a>"));
}

TEST_CASE("a plan is drawn the same twice") {
    const std::string text =
        "wires = [\"s.value -> r.in as linear\"]\n" + a_node("s", "source") + a_node("r", "relay", "60 Hz");
    CHECK(picture_of(text) == picture_of(text));
}

TEST_CASE("a name too long for its box is set smaller, and cut when that is not enough") {
    const std::string svg =
        picture_of(a_node(std::string(25, 'n'), "source") + a_node(std::string(200, 'm'), "source"));
    CHECK_THAT(svg, ContainsSubstring(">" + std::string(25, 'n') + "<") &&
                        ContainsSubstring(">" + std::string(39, 'm') + "…<"));
    CHECK_THAT(svg, ContainsSubstring("font-size=\"8.4\"") && ContainsSubstring("font-size=\"5.2\""));
}
