// SPDX-License-Identifier: Apache-2.0
// Edits of a patch at the bench, as its picture makes them: wires, lanes, comments and sub-patches.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/document/part_ports.hpp"
#include "tools/window/document/workbench.hpp"
#include "tools/window/patch/wire_choices.hpp"

#include <fmt/format.h>

#include <algorithm>

using namespace tactus;
using namespace tactus::run;
using namespace tactus::window;
using tactus::test::Folder;
using tactus::test::voice;

namespace {

RunChoice patching_choice(const Folder& folder, const std::string& text) {
    RunChoice choice;
    choice.patch = folder.write("outer.toml", text).string();
    choice.out = folder.path / "out";
    choice.audio = "file";
    return choice;
}

bool has(const Workbench& bench, const std::string& part) {
    std::string text = bench.editor().text();
    // Arrows stand below each other.
    text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; }), text.end());
    return text.find(part) != std::string::npos;
}

int undone(Workbench& bench) {
    int steps = 0;
    while (bench.undo()) ++steps;
    return steps;
}

const std::string ear = R"(title = "ear"
wires = ["loud.out -> sum.in"]
[inputs]
sound = "loud.in"
[outputs]
out = "sum.out"
[parameters]
level = "loud.factor"
[nodes.loud]
type = "gain"
rate = "outer"
factor = 0.25
[nodes.sum]
type = "gain"
rate = "outer"
)";

const std::string hears = R"(title = "hears"
wires = ["tone.signal -> part.sound"]
[nodes.tone]
type = "sine"
rate = "48 kHz"
[nodes.part]
type = "patch:ear.toml"
rate = "48 kHz"
)";

}  // namespace

TEST_CASE("a counter of events waits for the node that feeds it, and runs as soon as another one does") {
    const Folder folder;
    Workbench bench(patching_choice(folder, ""));
    REQUIRE(bench.add_node("event_delay", "1 kHz") == "event_delay");
    REQUIRE(bench.add_node("event_counter", "1 kHz") == "event_counter");
    // The delay has no events yet: with it, its only wire does not run.
    REQUIRE(bench.connect("event_delay.out", "event_counter.in"));
    CHECK(bench.unfinished().nodes.size() == 2);
    REQUIRE(bench.add_node("button_events", "1 kHz") == "button_events");
    REQUIRE(bench.connect("button_events.events", "event_counter.in"));
    CHECK(has(bench, "event_delay.out -> event_counter.in"));
    CHECK(bench.unfinished().names() == std::vector<std::string>{"event_delay"});
    REQUIRE(bench.connect("button_events.events", "event_delay.in"));
    CHECK(bench.unfinished().empty());
    // In a finished chain a wire comes off.
    REQUIRE(bench.disconnect("event_counter.in", "button_events.events"));
    REQUIRE(bench.disconnect("event_delay.in"));
    CHECK(bench.unfinished().nodes.size() == 2);
}

TEST_CASE("a sub-patch that takes events keeps its wires when another one is added") {
    const Folder folder;
    folder.write("count.toml", R"([inputs]
events = "count.in"
[outputs]
count = "count.count"
[nodes.count]
type = "event_counter"
rate = "1 kHz"
)");
    Workbench bench(patching_choice(folder, R"(wires = ["a.events -> part.events"]
[nodes]
a = { type = "button_events", rate = "1 kHz" }
b = { type = "button_events", rate = "1 kHz" }
part = { type = "patch:count.toml" }
)"));
    REQUIRE(bench.connect("b.events", "part.events"));
    CHECK(has(bench, "a.events -> part.events"));
    CHECK(has(bench, "b.events -> part.events"));
    REQUIRE(bench.disconnect("part.events", "a.events"));
    CHECK(has(bench, "b.events -> part.events"));
}

TEST_CASE("a sub-patch may stand without its wires like any node") {
    const Folder folder;
    folder.write("ear.toml", ear);
    Workbench bench(patching_choice(folder, hears));
    REQUIRE_FALSE(bench.is_broken());
    CHECK(bench.unfinished().empty());
    REQUIRE(bench.disconnect("part.sound"));
    REQUIRE(bench.unfinished().nodes.size() == 1);
    CHECK(bench.unfinished().nodes[0].lacks == "input 'sound' has no wire");
    const int index = bench.picture().find("part");
    REQUIRE(index >= 0);
    const PictureNode& part = bench.picture().nodes[static_cast<std::size_t>(index)];
    CHECK((part.inputs.size() == 1 && part.inputs[0].name == "sound"));
    CHECK((part.outputs.size() == 1 && part.outputs[0].name == "out"));
    REQUIRE(bench.connect("tone.signal", "part.sound"));
    CHECK(bench.unfinished().empty());
    CHECK(bench.paste(bench.copy({"part"}), {30.0, 30.0}).nodes == std::vector<std::string>{"part_2"});
    CHECK(bench.unfinished().names() == std::vector<std::string>{"part_2"});
    // What feeds it goes; a parameter that it offers can do without.
    REQUIRE(bench.add_node("constant", "60 Hz") == "constant");
    REQUIRE(bench.connect("constant.value", "part.level"));
    REQUIRE(bench.remove("constant"));
    CHECK(bench.unfinished().find("part") == nullptr);
    REQUIRE(bench.remove("tone"));
    CHECK(bench.unfinished().find("part") != nullptr);
}

TEST_CASE("the parameters that a sub-patch offers can be set, also at the nodes within") {
    const Folder folder;
    folder.write("ear.toml", ear);
    Workbench bench(patching_choice(folder, hears));
    const auto part = [&] {
        const auto fields = parameters_of_part(bench.written(), bench.written().nodes[1]);
        REQUIRE(fields.size() == 1);
        return fields[0];
    };
    CHECK(part().name == "level");
    CHECK(part().value == Approx(0.25));
    CHECK_FALSE(part().is_set);
    REQUIRE(bench.set("part", "level", "0.5"));
    CHECK(part().value == Approx(0.5));
    CHECK(part().normal == Approx(0.25));
    REQUIRE(bench.open_sub_patch("part", true));
    REQUIRE(bench.set("part:loud", "factor", "0.75"));
    CHECK(part().value == Approx(0.75));
    CHECK(bench.offered_as("part:sum", "factor").empty());
    CHECK_FALSE(bench.set("part:sum", "factor", "2"));
    REQUIRE(bench.reset("part:loud", "factor"));
    CHECK_FALSE(part().is_set);
}

TEST_CASE("a patch file becomes a node of the patch, with a rate where its nodes need one") {
    const Folder folder;
    folder.write("ear.toml", ear);
    folder.write("notes.toml", "what is this\n");
    Workbench bench(patching_choice(folder, voice));
    REQUIRE(bench.add_part(folder.path / "ear.toml", "") == "ear");
    CHECK(has(bench, "type = \"patch:ear.toml\"\nrate = \"1 kHz\""));
    CHECK(bench.unfinished().names() == std::vector<std::string>{"ear"});
    REQUIRE(bench.add_part(folder.path / "ear.toml", "48 kHz") == "ear_2");
    REQUIRE(bench.connect("tone.signal", "ear_2.sound"));
    CHECK(bench.unfinished().names() == std::vector<std::string>{"ear"});
    CHECK(bench.add_part(folder.path / "notes.toml", "").empty());
    // A patch within itself.
    CHECK(bench.add_part(folder.path / "outer.toml", "").empty());
    CHECK(bench.messages().back().is_problem);
}

TEST_CASE("a node moves to another rate or group as one edit, and a rate that is none is refused") {
    const Folder folder;
    Workbench bench(patching_choice(folder, voice));
    REQUIRE(bench.has_lane("level"));
    REQUIRE(bench.move_to_lane({"level"}, "1 kHz", {{"level", {50.0, 60.0}}}));
    CHECK(has(bench, "type = \"constant\"\nrate = \"1 kHz\""));
    CHECK(bench.window().places.at("level").x == 50.0);
    CHECK_FALSE(bench.move_to_lane({"level"}, "3 kg"));
    CHECK(undone(bench) == 1);
    CHECK(bench.editor().text() == voice);
}

TEST_CASE("a node of sound that is put in a slow lane goes to a lane of sound") {
    const Folder folder;
    Workbench bench(patching_choice(folder, voice));
    CHECK(bench.lane_for("sine", "60 Hz") == "48 kHz");
    CHECK(bench.lane_for("sine", "48 kHz") == "48 kHz");
    CHECK(bench.lane_for("constant", "60 Hz") == "60 Hz");
    CHECK(bench.lane_for("constant", "part:slow") == bench.lane_for("constant"));
}

TEST_CASE("a node that is added at the end of a wire is one edit with it") {
    const Folder folder;
    Workbench bench(patching_choice(folder, voice));
    REQUIRE(bench.add_node("gain", "48 kHz", patch::PatchPlace{10.0, 40.0}, "tone.signal", "in") == "gain");
    CHECK(bench.unfinished().empty());
    CHECK(has(bench, "tone.signal -> gain.in"));
    CHECK(undone(bench) == 1);
    CHECK(bench.editor().text() == voice);
    // Where the wire is refused the node comes without it.
    CHECK(bench.add_node("gain", "48 kHz", std::nullopt, "tone.nothing", "in") == "gain");
    CHECK(bench.unfinished().names() == std::vector<std::string>{"gain"});
}

TEST_CASE("a wire led to another source keeps how it is delivered and where it is written") {
    const Folder folder;
    std::string text = voice;
    text.replace(text.find("loud.factor"), 11, "loud.factor as linear");
    Workbench bench(patching_choice(folder, text + "[nodes.other]\ntype = \"constant\"\nrate = \"60 Hz\"\n"));
    const auto line_of = [&](const std::string& part) {
        const std::string now = bench.editor().text();
        return std::count(now.begin(), now.begin() + static_cast<std::ptrdiff_t>(now.find(part)), '\n');
    };
    const auto line = line_of("loud.factor as linear");
    REQUIRE(bench.reconnect_source("level.value", "other.value", "loud.factor"));
    CHECK(has(bench, "other.value -> loud.factor as linear"));
    CHECK(line_of("loud.factor as linear") == line);
    CHECK_FALSE(has(bench, "level.value -> "));
    CHECK(undone(bench) == 1);
    CHECK_FALSE(bench.reconnect_source("level.value", "tone.signal", "loud.factor"));
}

TEST_CASE("of several sources of events only the one that is led away changes") {
    const Folder folder;
    Workbench bench(patching_choice(folder, R"(wires = ["a.events -> count.in", "b.events -> count.in"]
[nodes]
a = { type = "button_events", rate = "1 kHz" }
b = { type = "button_events", rate = "1 kHz" }
c = { type = "button_events", rate = "1 kHz" }
count = { type = "event_counter", rate = "1 kHz" }
)"));
    REQUIRE(bench.reconnect_source("b.events", "c.events", "count.in"));
    CHECK(has(bench, "a.events -> count.in"));
    CHECK(has(bench, "c.events -> count.in"));
    CHECK_FALSE(has(bench, "b.events -> count.in"));
}

TEST_CASE("a comment that is added tells its own name, whatever others are called") {
    const Folder folder;
    Workbench bench(patching_choice(folder, voice + "[window.comments.why]\ntext = \"because\"\n"));
    CHECK(bench.add_comment({0.0, 0.0}, "new") == "note");
    for (int i = 2; i <= 11; ++i) CHECK(bench.add_comment({0.0, 0.0}, "new") == fmt::format("note_{}", i));
}

TEST_CASE("nodes and comments move and go together as one edit") {
    const Folder folder;
    Workbench bench(patching_choice(folder, voice));
    REQUIRE(bench.add_comment({5.0, 6.0}, "why") == "note");
    patch::PatchComment comment = bench.window().comments[0];
    comment.place = {50.0, 60.0};
    REQUIRE(bench.place({{"tone", {1.0, 2.0}}}, {comment}));
    CHECK(bench.window().comments[0].place.x == 50.0);
    REQUIRE(bench.remove({"level"}, {"note"}));
    CHECK(bench.window().comments.empty());
    CHECK(bench.picture().find("level") < 0);
    CHECK(undone(bench) == 3);
}

TEST_CASE("of a large patch the possible wires are listed up to a bound, and that there are more is said") {
    std::string text;
    for (int i = 0; i < 100; ++i)
        text += fmt::format(
            "[nodes.a{0}]\ntype = \"constant\"\nrate = \"60 Hz\"\n[nodes.b{0}]\ntype = \"gain\"\nrate = "
            "\"60 Hz\"\n",
            i);
    const Folder folder;
    const Workbench bench(patching_choice(folder, text));
    const WireChoices some = wire_choices(bench.picture(), 4000);
    CHECK(some.list.size() == 4000);
    CHECK(some.has_more);
    const Folder other;
    const Workbench small(patching_choice(other, voice));
    const WireChoices all = wire_choices(small.picture(), 4000);
    CHECK_FALSE(all.has_more);
    CHECK(std::ranges::any_of(all.list, [](const WireChoice& choice) {
        return choice.from == "level.value" && choice.to == "tone.amplitude" && choice.drives;
    }));
}
