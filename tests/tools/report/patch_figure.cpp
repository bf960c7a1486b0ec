// SPDX-License-Identifier: Apache-2.0
#include "tools/report/patch/patch_figure.hpp"

#include "devices/display/figure_painter.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"
#include "tests/support/places.hpp"
#include "tools/run/load_plan.hpp"

#include <cmath>
#include <optional>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string picture_of(const std::string& text) {
    const Compiled c = compiled(text);
    INFO(c.said);
    REQUIRE(c.plan);
    return report::draw_patch(*c.plan).svg();
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
    const Compiled c = compiled(a_node(std::string(25, 'n'), "source") + a_node(std::string(200, 'm'), "source"));
    REQUIRE(c.plan);
    const display::Figure figure = report::draw_patch(*c.plan);
    int checked = 0;
    for (const display::Figure::Item& item : figure.items())
        if (const auto* text = std::get_if<display::Figure::Text>(&item);
            text && text->bold && text->text.size() > 20) {
            CAPTURE(text->text);
            const bool is_cut = text->text.ends_with("…");
            CHECK(is_cut == text->text.starts_with("m"));
            CHECK(display::figure_painter().text_width(text->text, text->size, true) <= 138.01);
            ++checked;
        }
    CHECK(checked == 2);
}

TEST_CASE("labels of wires do not overlap, however many wires end at a node") {
    for (const char* name : {"saw-guide", "saw-training", "planning-trauma"}) {
        run::PatchChoice choice;
        choice.patch = (test::library_folder() / "patches" / name).string() + ".toml";
        patch::Problems problems;
        const std::optional<compile::Schedule> plan = run::read_plan(choice, problems);
        REQUIRE(plan);
        const display::Figure figure = report::draw_patch(*plan);
        std::vector<const display::Figure::Text*> labels;
        for (const display::Figure::Item& item : figure.items())
            if (const auto* one = std::get_if<display::Figure::Text>(&item); one && one->halo) labels.push_back(one);
        CAPTURE(name);
        CHECK(labels.size() > 5);
        for (const auto* a : labels)
            for (const auto* b : labels) {
                if (a == b || a->at.x != b->at.x) continue;
                CAPTURE(a->text, a->at.y, b->text, b->at.y);
                CHECK(std::abs(a->at.y - b->at.y) >= a->size);
            }
    }
}
