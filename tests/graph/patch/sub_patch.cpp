// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/sub_patch.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/compile_nodes.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string part(const std::string& path, const std::string& text) {
    return "\n[[parts]]\npath = '" + path + "'\ntext = '''\n" + text + "'''\n";
}

/// Two gains in a row, offered as one.
const std::string pair_text = R"(wires = [ "first.out -> second.in" ]
[inputs]
in = "first.in"
[outputs]
out = "second.out"
[parameters]
both = ["first.stiffness", "second.stiffness"]
last = "second.stiffness"

)" + a_node("first", "stiff", "outer") +
                              a_node("second", "stiff", "outer", "stiffness = \"3 N/m\"\n");

std::string using_pair(const std::string& more = "",
                       const std::string& wires = "\"s.value -> pair.in\", \"pair.out -> end.in\"") {
    return "wires = [ " + wires + " ]\n" + a_node("s", "source") + "[nodes.pair]\ntype = \"patch:pair.toml\"\n" +
           (more.empty() ? "rate = \"1 kHz\"\n" : more) + a_node("end", "stiff");
}

}  // namespace

TEST_CASE("a patch as a node compiles to what it would be, written out") {
    const Compiled one = compiled(using_pair() + part("pair.toml", pair_text));
    REQUIRE(one.said == "");
    CHECK(order_of(*one.plan, 0) == "s pair:first pair:second end");
    CHECK(one.plan->wires.size() == 3);
    CHECK(one.plan->groups.size() == 1);
}

TEST_CASE("parameters of a patch within reach all that they stand for, and replace what it says itself") {
    const auto factor = [](const Compiled& c, const char* node) {
        const auto found = std::ranges::find(c.plan->nodes, node, &compile::ScheduleNode::name);
        return found->params.at("stiffness")->value;
    };
    const Compiled both = compiled(using_pair("rate = \"1 kHz\"\nboth = \"5 N/m\"\n") + part("pair.toml", pair_text));
    REQUIRE(both.said == "");
    CHECK(factor(both, "pair:first") == 5.0);
    CHECK(factor(both, "pair:second") == 5.0);
    const Compiled last = compiled(using_pair("rate = \"1 kHz\"\nlast = \"7 N/m\"\n") + part("pair.toml", pair_text));
    REQUIRE(last.said == "");
    CHECK(factor(last, "pair:second") == 7.0);
    const Compiled own = compiled(using_pair() + part("pair.toml", pair_text));
    CHECK(factor(own, "pair:second") == 3.0);
    CHECK(patch::ends_within(own.plan->patch, "pair", "last").front().node == "pair:second");
    CHECK(patch::ends_within(own.plan->patch, "end", "stiffness").front().node == "end");
}

TEST_CASE("patches nest, with groups, rates and offers led through") {
    const std::string outer = R"(wires = [ "a.out -> b.in" ]
[inputs]
in = "a.in"
[outputs]
out = "b.out"
[parameters]
all = ["a.both", "b.both"]
[groups.inner]
rate = "500 Hz"
[nodes.a]
type = "patch:../pair.toml"
rate = "outer"
[nodes.b]
type = "patch:../pair.toml"
group = "inner"
)";
    const Compiled c = compiled("wires = [ \"s.value -> quad.in\", \"quad.out -> end.in\" ]\n" + a_node("s", "source") +
                                "[nodes.quad]\ntype = \"patch:deep/quad.toml\"\nrate = \"1 kHz\"\nall = \"2 N/m\"\n" +
                                a_node("end", "stiff") + part("deep/quad.toml", outer) + part("pair.toml", pair_text));
    REQUIRE(c.said == "");
    REQUIRE(c.plan->groups.size() == 2);
    CHECK(order_of(*c.plan, 0) == "end s quad:a:first quad:a:second");
    CHECK(c.plan->groups[1].name == "quad:inner");
    CHECK(order_of(*c.plan, 1) == "quad:b:first quad:b:second");
    for (const compile::ScheduleNode& node : c.plan->nodes)
        if (node.name.starts_with("quad:")) CHECK(node.params.at("stiffness")->value == 2.0);
    CHECK(patch::ends_within(c.plan->patch, "quad", "out").front().node == "quad:b:second");
    CHECK(patch::ends_within(c.plan->patch, "quad:a", "in").front().node == "quad:a:first");
}

//  top ► p8 ► … ► p1 ► pair: every level offers the parameter of the level below
TEST_CASE("a parameter with several targets reaches all of them from any depth") {
    std::string parts = part("pair.toml", pair_text);
    for (int depth = 1; depth <= 8; ++depth) {
        const std::string below = depth == 1 ? "pair.toml" : fmt::format("p{}.toml", depth - 1);
        parts += part(fmt::format("p{}.toml", depth),
                      "[inputs]\nin = \"n.in\"\n[outputs]\nout = \"n.out\"\n[parameters]\nboth = \"n.both\"\n"
                      "[nodes.n]\ntype = \"patch:" +
                          below + "\"\nrate = \"outer\"\n");
        const Compiled c = compiled(
            "wires = [ \"s.value -> top.in\", \"top.out -> end.in\" ]\n" + a_node("s", "source") +
            fmt::format("[nodes.top]\ntype = \"patch:p{}.toml\"\nrate = \"1 kHz\"\nboth = \"9 N/m\"\n", depth) +
            a_node("end", "stiff") + parts);
        INFO(depth << ": " << c.said);
        REQUIRE(c.plan);
        int set = 0;
        for (const compile::ScheduleNode& node : c.plan->nodes)
            if (node.name.starts_with("top:")) set += node.params.at("stiffness")->value == 9.0;
        CHECK(set == 2);
        const auto ends = patch::ends_within(c.plan->patch, "top", "both");
        REQUIRE(ends.size() == 2);
        CHECK(ends[0].node.ends_with(":first"));
        CHECK(ends[1].node.ends_with(":second"));
    }
}

TEST_CASE("what is wrong with a patch within is said where it is written") {
    const std::string whole = part("pair.toml", pair_text);
    CHECK_THAT(compiled(using_pair("", "\"s.value -> pair.inn\"") + whole).said,
               ContainsSubstring("p.toml:1:12: pair.toml offers no input 'inn'; did you mean 'in'?"));
    CHECK_THAT(compiled(using_pair("", "\"pair.ou -> end.in\"") + whole).said,
               ContainsSubstring("pair.toml offers no output 'ou'; did you mean 'out'?"));
    CHECK_THAT(compiled(using_pair("rate = \"1 kHz\"\nlst = \"1 N/m\"\n") + whole).said,
               ContainsSubstring("p.toml:8:7: pair.toml offers no parameter 'lst'; did you mean 'last'?"));
    CHECK_THAT(compiled(using_pair("last = \"1 N/m\"\n") + whole).said,
               ContainsSubstring("node 'pair' needs a 'rate' or a 'group'"));
    CHECK_THAT(compiled(using_pair()).said,
               ContainsSubstring("p.toml:6:8: there is no patch pair.toml that can be read"));
    CHECK_THAT(compiled(using_pair() + part("pair.toml", "[nodes.x\n")).said, ContainsSubstring("pair.toml:1:"));
    CHECK_THAT(compiled(using_pair() + part("pair.toml", a_node("x", "gian"))).said,
               ContainsSubstring("leave this one out"));
    CHECK_THAT(
        compiled(using_pair() + part("pair.toml", "[inputs]\nin = \"y.in\"\n" + a_node("x", "stiff", "outer"))).said,
        ContainsSubstring("pair.toml:2:6: no node 'y'"));
    CHECK_THAT(
        compiled(using_pair() + part("pair.toml", "[inputs]\nin = \"yin\"\n" + a_node("x", "stiff", "outer"))).said,
        ContainsSubstring("pair.toml:2:6: 'in' must name what it controls"));
    CHECK_THAT(compiled(pair_text).said, ContainsSubstring("rate = \"outer\" is that of a node which is this patch"));
    CHECK_THAT(compiled("[nodes.a]\ntype = \"patch:\"\n").said, ContainsSubstring("name the file"));
}

TEST_CASE("patches within themselves, and thickets of them, end with one message") {
    const std::string self = "[nodes.again]\ntype = \"patch:self.toml\"\n";
    CHECK_THAT(compiled("[nodes.a]\ntype = \"patch:self.toml\"\n" + part("self.toml", self)).said,
               ContainsSubstring("a patch within itself: p.toml -> self.toml -> self.toml"));
    CHECK_THAT(compiled("[nodes.a]\ntype = \"patch:p.toml\"\n").said, ContainsSubstring("a patch within itself"));
    std::string thicket = "[nodes.a]\ntype = \"patch:0.toml\"\n";
    for (int level = 0; level < 12; ++level) {
        std::string ten;
        for (int i = 0; i < 10; ++i)
            ten += "[nodes.n" + std::to_string(i) + "]\ntype = \"patch:" + std::to_string(level + 1) + ".toml\"\n";
        thicket += part(std::to_string(level) + ".toml", ten);
    }
    thicket += part("12.toml", a_node("leaf", "source"));
    const std::string said = compiled(thicket).said;
    CHECK_THAT(said, ContainsSubstring("more than 100000 nodes within each other"));
    CHECK(std::ranges::count(said, '\n') == 1);
}

TEST_CASE("a bundle holds the patch and all within it, to the byte, wherever it is read") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("tactus-{}", ::getpid());
    const std::string odd = "# \"\"\" '''  \\ \t é\r\n" + pair_text;
    std::filesystem::create_directories(folder / "deep");
    std::ofstream(folder / "deep" / "pair.toml") << odd;
    std::string text = using_pair();
    text.replace(text.find("pair.toml"), 9, "deep/pair.toml");
    std::ofstream(folder / "p.toml") << text;
    patch::Problems problems;
    const patch::Patch loaded = patch::load_patch(folder / "p.toml", problems);
    REQUIRE(problems.empty());
    REQUIRE(loaded.parts.size() == 1);
    CHECK(patch::part_files(loaded).front() == folder / "deep/pair.toml");
    std::filesystem::remove_all(folder);
    const std::string bundle = patch::bundle_text(loaded);
    const patch::Patch again = patch::read_patch(bundle, "elsewhere.toml", problems);
    REQUIRE(said(problems) == "");
    CHECK(again.text == text);
    CHECK(again.parts == loaded.parts);
    CHECK(again.parts.front().text == odd);
    CHECK(patch::bundle_text(again) == bundle);
    patch::Patch flat = again;
    patch::flatten(flat, problems);
    CHECK(problems.empty());
    CHECK(flat.nodes.size() == 4);
    CHECK_THAT(problems_of("[[parts]]\npath = 'a'\ntext = 'b'\n[nodes.x]\ntype = 'stiff'\nrate = '1 kHz'\n"),
               ContainsSubstring("[[parts]] stand at the end of a patch"));
}

TEST_CASE("assets and devices of a patch within are its own, unless the outer patch gives them") {
    const std::string within =
        "[parameters]\nfile = \"x.asset\"\n[assets]\nbone = \"b.vdb\"\n[devices.pen]\ndriver = "
        "\"simulated\"\n[nodes.x]\ntype = \"truth\"\nrate = \"1 kHz\"\nasset = \"bone\"\n";
    patch::Problems problems;
    patch::Patch patch = patch_of(
        "[assets]\nbone = \"a.vdb\"\n[devices.pen]\ndriver = \"real\"\n[nodes.own]\ntype = "
        "\"patch:w.toml\"\n[nodes.given]\ntype = \"patch:w.toml\"\nfile = \"bone\"\n" +
        part("w.toml", within));
    patch::flatten(patch, problems);
    REQUIRE(said(problems) == "");
    REQUIRE(patch.assets.size() == 3);
    CHECK(patch.assets[1].name == "own:bone");
    CHECK(patch.assets[1].path == "folder/b.vdb");
    REQUIRE(patch.devices.size() == 1);
    CHECK(patch.devices[0].driver == "real");
    CHECK(patch.nodes[0].settings[0].scope + patch.nodes[0].settings[0].text == "own:bone");
    CHECK(patch.nodes[1].settings[0].scope + patch.nodes[1].settings[0].text == "bone");
}
