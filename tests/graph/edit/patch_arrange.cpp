// SPDX-License-Identifier: Apache-2.0
#include "graph/edit/patch_arrange.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

using namespace tactus;
using namespace tactus::edit;

namespace {

const std::string ball = R"(title = "Ball"   # a ball
wires = [
  "hand.pose   -> ball.pose",
  "ball.wrench -> out.wrench",
  "hand.trigger -> ball.on as delay 2",
]
[groups.slow]
rate = "60 Hz"
[assets]
bone = "parts/bone.vdb"
[nodes.hand]
type = "device_input"
rate = "1 kHz"

# the ball
[nodes.ball]
type      = "sphere_contact"
group     = "slow"
stiffness = "0.8 N/mm"   # soft
shape     = "bone"
[nodes.out]
type = "device_output"
rate = "1 kHz"
)";

patch::Patch read(const std::string& text) {
    patch::Problems problems;
    patch::Patch patch = patch::read_patch(text, "p.toml", problems);
    for (const Error& error : problems.list) FAIL(error.what());
    return patch;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("places, colours and comments are kept in the patch, and no other byte changes") {
    std::string text = with_places(ball, {{"ball", {240.4, 59.6}}});
    CHECK(text == ball + "\n[window.places]\nball = [240, 60]\n");
    text = with_places(text, {{"ball", {10.0, -5.0}}, {"out", {1.0, 2.0}}});
    CHECK(text == ball + "\n[window.places]\nball = [10, -5]\nout  = [1, 2]\n");
    const std::vector<std::string> two{"ball", "out"};
    std::string coloured = with_colours(text, two, "amber");
    CHECK(patch::window_of(coloured).colours.at("out") == "amber");
    CHECK(patch::window_of(with_colours(coloured, two, "")).colours.empty());
    const std::string noted =
        with_comment(coloured, {"why", "two\nlines \"quoted\"", "blue", {5.0, 6.0}, {100.0, 50.0}});
    const patch::PatchWindow window = patch::window_of(noted);
    REQUIRE(window.comments.size() == 1);
    CHECK(window.comments[0].text == "two\nlines \"quoted\"");
    CHECK(window.comments[0].size.x == 100.0);
    CHECK(window.places.at("ball").x == 10.0);
    read(noted);
    CHECK(has(noted, "title = \"Ball\"   # a ball\n"));
    CHECK(patch::window_of(without_comment(noted, "why")).comments.empty());
    CHECK_THROWS_AS(without_comment(noted, "none"), Error);
    CHECK(patch::window_of(with_layout(noted, "train")).layout == "train");
}

TEST_CASE("a node that goes, or has another name, takes its place along") {
    const std::string placed = with_places(ball, {{"ball", {1.0, 2.0}}, {"out", {3.0, 4.0}}});
    const auto renamed = patch::window_of(with_node_named(placed, "ball", "sphere"));
    CHECK(renamed.places.contains("sphere"));
    CHECK_FALSE(renamed.places.contains("ball"));
    CHECK_FALSE(patch::window_of(without_node(placed, "ball")).places.contains("ball"));
    CHECK(patch::window_of(without_node(placed, "ball")).places.contains("out"));
}

TEST_CASE("an open sub-patch stays open under another name and leaves the list when it goes") {
    std::string text = with_open_parts(ball, std::vector<std::string>{"hand", "ball", "out"});
    text = with_node_named(text, "ball", "sphere");
    CHECK(patch::window_of(text).open == std::vector<std::string>{"hand", "sphere", "out"});
    text = without_node(text, "sphere");
    CHECK(patch::window_of(text).open == std::vector<std::string>{"hand", "out"});
    text = without_node(text, "out");
    CHECK(patch::window_of(text).open == std::vector<std::string>{"hand"});
    text = without_node(text, "hand");
    CHECK(patch::window_of(text).open.empty());
}

TEST_CASE("a node changes its lane where its rate or group is written") {
    const std::string fast = with_lane(ball, "ball", "1 kHz", false);
    CHECK(has(fast, "[nodes.ball]\ntype      = \"sphere_contact\"\nrate      = \"1 kHz\"\nstiffness"));
    CHECK(with_lane(fast, "ball", "slow", true) == ball);
    CHECK(read(fast).nodes[1].group.empty());
    const std::string slow = with_lane(fast, "hand", "slow", true);
    CHECK(has(slow, "[nodes.hand]\ntype = \"device_input\"\ngroup = \"slow\"\n"));
    CHECK(read(with_lane(slow, "hand", "2 kHz", false)).nodes[0].rate == "2 kHz");
    CHECK(read(with_lane(ball, "hand", "2 kHz", false)).nodes[0].rate == "2 kHz");
    CHECK_THROWS_AS(with_lane(ball, "nobody", "1 kHz", false), Error);
    CHECK_THROWS_AS(with_lane(ball, "part:ball", "1 kHz", false), Error);
}

TEST_CASE("a pasted group brings its latency and backlog and is another group where one of them differs") {
    const std::string late =
        "[groups.slow]\nrate = \"60 Hz\"\nlatency = \"250 ms\"\nbacklog = 3\n"
        "[nodes.a]\ntype = \"constant\"\ngroup = \"slow\"\n";
    const std::string copy = copied(late, std::vector<std::string>{"a"}, "/tmp");
    const auto group_of = [](const patch::Patch& patch, const std::string& name) {
        const auto found = std::ranges::find(patch.groups, name, &patch::PatchGroup::name);
        return found == patch.groups.end() ? patch::PatchGroup{} : *found;
    };
    const patch::Patch alone =
        read(with_pasted("[nodes.b]\ntype = \"constant\"\nrate = \"60 Hz\"\n", copy, {{"a", "a"}}, {0.0, 0.0}));
    CHECK(group_of(alone, "slow").latency == "250 ms");
    CHECK(group_of(alone, "slow").backlog == 3);
    const patch::Patch beside = read(with_pasted(ball, copy, {{"a", "a"}}, {0.0, 0.0}));
    CHECK(group_of(beside, "slow").latency.empty());
    CHECK(group_of(beside, "slow_2").latency == "250 ms");
    CHECK(beside.nodes.back().group == "slow_2");
    CHECK(read(with_pasted(late, copy, {{"a", "a_2"}}, {0.0, 0.0})).groups.size() == 1);
}

TEST_CASE("what a window keeps is checked where it stands") {
    const auto problem = [](const std::string& more) {
        patch::Problems problems;
        patch::read_patch(ball + more, "p.toml", problems);
        return problems.list.empty() ? std::string() : problems.list.front().message();
    };
    CHECK(problem("[window]\nlayout = \"plan\"\n").empty());
    CHECK(has(problem("[window]\nlayout = \"desk\"\n"), "\"patch\", \"plan\" or \"train\""));
    CHECK(has(problem("[window]\nplaes = 1\n"), "did you mean 'places'"));
    CHECK(has(problem("[window.places]\nball = [1]\n"), "two numbers"));
    CHECK(has(problem("[window.places]\nball = [1, inf]\n"), "two numbers"));
    CHECK(has(problem("[window.colours]\nball = \"ambr\"\n"), "did you mean 'amber'"));
    CHECK(has(problem("window = 3\n"), ""));
    // A place of a node that is gone harms nothing.
    CHECK(problem("[window.places]\ngone = [1, 2]\n").empty());
}

TEST_CASE("copied nodes keep their settings, wires between them, groups and assets, and are pasted under other names") {
    const std::vector<std::string> both{"hand", "ball"};
    const std::string copy = copied(with_places(ball, {{"ball", {100.0, 50.0}}}), both, "/home/x");
    const patch::Patch part = read(copy);
    REQUIRE(part.nodes.size() == 2);
    CHECK(part.wires.size() == 2);
    REQUIRE(part.assets.size() == 1);
    CHECK(part.assets[0].path == "/home/x/parts/bone.vdb");
    CHECK(part.groups.size() == 1);
    const std::string pasted = with_pasted(ball, copy, {{"hand", "hand_2"}, {"ball", "ball_2"}}, {40.0, 40.0});
    const patch::Patch all = read(pasted);
    REQUIRE(all.nodes.size() == 5);
    CHECK(all.wires.size() == 5);
    CHECK(has(pasted, "hand_2.trigger"));
    CHECK(has(pasted, "as delay 2"));
    CHECK(all.assets.size() == 1);
    CHECK(patch::window_of(pasted).places.at("ball_2").x == 140.0);
    const auto copied_ball = std::ranges::find(all.nodes, "ball_2", &patch::PatchNode::name);
    REQUIRE(copied_ball != all.nodes.end());
    CHECK(copied_ball->group == "slow");
    CHECK(std::ranges::find(copied_ball->settings, "stiffness", &OptionText::name)->text == "0.8 N/mm");
    CHECK_THROWS_AS(with_pasted(ball, "no patch at all", {}, {}), Error);
}

TEST_CASE("a copy from another patch brings its own files and rates where their names mean others") {
    const std::vector<std::string> one{"ball"};
    const std::string copy = copied(ball, one, "/home/x");
    std::string here = ball;
    here.replace(here.find("\"60 Hz\""), 7, "\"30 Hz\"");
    const std::map<std::string, std::string> names{{"ball", "ball_2"}};
    const patch::Patch all = read(with_pasted(here, copy, names, {}, "/home/y"));
    REQUIRE(all.assets.size() == 2);
    CHECK(std::ranges::find(all.assets, "bone_2", &patch::PatchAsset::name)->path == "/home/x/parts/bone.vdb");
    const auto pasted = std::ranges::find(all.nodes, "ball_2", &patch::PatchNode::name);
    REQUIRE(pasted != all.nodes.end());
    CHECK(pasted->group == "slow_2");
    const auto group = std::ranges::find(all.groups, "slow_2", &patch::PatchGroup::name);
    REQUIRE(group != all.groups.end());
    CHECK(group->rate == "60 Hz");
    // In its own folder the file is the same.
    CHECK(read(with_pasted(ball, copy, names, {}, "/home/x")).assets.size() == 1);
}

TEST_CASE("two files or rates of a copy stay two, also where a new name is one that the copy has") {
    std::string two = ball;
    two.replace(two.find("bone = \"parts"), 4, "bone_2 = \"parts/second.vdb\"\nbone");
    two.replace(two.find("[assets]"), 8, "[groups.slow_2]\nrate = \"120 Hz\"\n[assets]");
    two += "[nodes.other]\ntype = \"sphere_contact\"\ngroup = \"slow_2\"\nshape = \"bone_2\"\n";
    const std::vector<std::string> both{"ball", "other"};
    std::string here = ball;
    here.replace(here.find("\"60 Hz\""), 7, "\"30 Hz\"");
    const patch::Patch all = read(
        with_pasted(here, copied(two, both, "/home/x"), {{"ball", "ball_2"}, {"other", "other_2"}}, {}, "/home/y"));
    const auto rate_of = [&](const std::string& node) {
        const std::string group = std::ranges::find(all.nodes, node, &patch::PatchNode::name)->group;
        return std::ranges::find(all.groups, group, &patch::PatchGroup::name)->rate;
    };
    CHECK(rate_of("ball") == "30 Hz");
    CHECK(rate_of("ball_2") == "60 Hz");
    CHECK(rate_of("other_2") == "120 Hz");
    CHECK(all.assets.size() == 3);
}

TEST_CASE("colours go along with copies, and a sub-patch keeps how its nodes stood") {
    const std::vector<std::string> both{"hand", "ball"};
    const std::string dressed = with_colours(with_places(ball, {{"hand", {20.0, 90.0}}, {"ball", {100.0, 50.0}}}),
                                             std::vector{both[1]}, "green");
    const std::string pasted =
        with_pasted(dressed, copied(dressed, both, "/home/x"), {{"hand", "hand_2"}, {"ball", "ball_2"}}, {});
    CHECK(patch::window_of(pasted).colours.at("ball_2") == "green");
    CHECK_FALSE(patch::window_of(pasted).colours.contains("hand_2"));
    const SubPatch made = with_sub_patch(dressed, both, "part", "part.toml", "/home/x");
    const patch::PatchWindow inner = patch::window_of(made.inner), outer = patch::window_of(made.outer);
    CHECK(inner.places.at("ball").x == 100.0);
    CHECK(inner.places.at("hand").y == 90.0);
    CHECK(inner.colours.at("ball") == "green");
    CHECK(outer.places.at("part").x == 20.0);
    CHECK(outer.places.at("part").y == 50.0);
    CHECK_FALSE(outer.places.contains("ball"));
}

TEST_CASE("chosen nodes become a patch of their own, and wires across its border its ends") {
    const std::vector<std::string> inner{"ball"};
    const SubPatch made = with_sub_patch(ball, inner, "contact", "contact.toml", "/home/x");
    const patch::Patch outer = read(made.outer), part = read(made.inner);
    CHECK(outer.nodes.size() == 3);
    CHECK(outer.wires.size() == 3);
    CHECK(has(made.outer, "type = \"patch:contact.toml\""));
    CHECK(has(made.outer, "contact.wrench -> out.wrench"));
    CHECK(has(made.outer, "as delay 2"));
    CHECK(part.nodes.size() == 1);
    CHECK(part.inputs.size() == 2);
    CHECK(part.outputs.size() == 1);
    CHECK(part.groups.size() == 1);
    CHECK_THROWS_AS(with_sub_patch(ball, {}, "contact", "contact.toml", "/home/x"), Error);
    CHECK_THROWS_AS(with_sub_patch(ball, inner, "hand", "contact.toml", "/home/x"), Error);
}

TEST_CASE("files and devices are named without touching what stands around them") {
    CHECK(has(with_asset(ball, "bone", "/other.vdb"), "bone = \"/other.vdb\""));
    CHECK(has(with_asset(ball, "saw", "/saw.toml"), "bone = \"parts/bone.vdb\"\nsaw  = \"/saw.toml\"\n"));
    const std::string device = with_device(ball, "simulated", "simulated");
    CHECK(device == ball + "\n[devices.simulated]\ndriver = \"simulated\"\n");
    const std::string set = with_device_setting(device, "simulated", "start_z", "60 mm");
    CHECK(has(set, "start_z = \"60 mm\""));
    CHECK(with_device_setting(set, "simulated", "start_z", "") == device);
    CHECK_THROWS_AS(with_asset(ball, "two words", "x"), Error);
}
