// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/workbench.hpp"
#include "engine/take/take_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/virtual_clock.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/signal/feed.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>

using namespace tactus;
using namespace tactus::run;
using namespace tactus::window;
using tactus::test::Folder;
using tactus::test::slurp;
using tactus::test::voice;

namespace {

RunChoice choice_in(const Folder& folder) {
    RunChoice choice;
    choice.patch = folder.write("voice.toml", voice).string();
    choice.out = folder.path / "out";
    choice.audio = "file";
    choice.json = true;
    return choice;
}

bool come_about(const std::function<bool()>& what) {
    for (int i = 0; i < 1500; ++i) {
        if (what()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

/// A run of a patch with two sources of events and a counter, and what is added.
RunChoice events_in(const Folder& folder, const std::string& wires, const std::string& more_nodes) {
    RunChoice choice = choice_in(folder);
    choice.patch = folder
                       .write("events.toml", "title = \"Events\"\n" + wires + R"(
[nodes]
slow = { type = "clock", rate = "1 kHz" }
fast = { type = "clock", rate = "1 kHz" }
a = { type = "button_events", rate = "1 kHz" }
b = { type = "button_events", rate = "1 kHz" }
count = { type = "event_counter", rate = "1 kHz" }
)" + more_nodes)
                       .string();
    return choice;
}

}  // namespace

TEST_CASE("an edit at the bench that does not compile is refused with the compiler's words") {
    const Folder folder;
    Workbench bench(choice_in(folder));
    CHECK_FALSE(bench.set("tone", "frequency", "3 kg"));
    CHECK(bench.messages().back().is_problem);
    CHECK(bench.messages().back().text.find("frequency") != std::string::npos);
    CHECK_FALSE(bench.connect("tone.signal", "loud.factor"));
    CHECK_FALSE(bench.rename("tone", "loud"));
    CHECK(bench.objection("tone.signal", "loud.factor"));
    CHECK_FALSE(bench.objection("tone.signal", "loud.in"));
    CHECK(bench.editor().text() == voice);
    CHECK(bench.picture().nodes.size() == 3);
}

TEST_CASE("a second wire to an input of events is added, and removing one leaves the other") {
    const Folder folder;
    Workbench bench(
        events_in(folder, R"(wires = ["slow.out -> a.in", "fast.out -> b.in", "a.events -> count.in"])", ""));
    REQUIRE(bench.plan());
    CHECK(bench.plan()->wires.size() == 3);
    REQUIRE(bench.connect("b.events", "count.in"));
    CHECK(bench.plan()->wires.size() == 4);
    REQUIRE(bench.disconnect("count.in", "a.events"));
    CHECK(bench.plan()->wires.size() == 3);
    CHECK(bench.editor().text().find("b.events -> count.in") != std::string::npos);
    // A number's input still has one wire.
    REQUIRE(bench.connect("slow.out", "b.in"));
    CHECK(bench.plan()->wires.size() == 3);
}

TEST_CASE("a wire led to another input by hand keeps how it is delivered, and takes no other wire along") {
    const Folder folder;
    Workbench bench(events_in(folder, R"(wires = [
  "slow.out -> a.in",
  "fast.out -> b.in",
  "a.events -> count.in",
  "b.events -> count.in",
  "a.events -> other.in",
  "level.value -> loud.factor as linear",
])",
                              R"(other = { type = "event_counter", rate = "1 kHz" }
level = { type = "constant", rate = "1 kHz" }
tone = { type = "sine", rate = "48 kHz" }
loud = { type = "gain", rate = "48 kHz" }
)"));
    REQUIRE_FALSE(bench.is_broken());
    const auto has = [&](const std::string& wire) {
        std::string text = bench.editor().text();
        // Arrows stand below each other.
        text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; }),
                   text.end());
        return text.find(wire) != std::string::npos;
    };
    // Of two wires to one input of events the one that is led away goes, and the one that is there stays.
    REQUIRE(bench.reconnect("b.events", "count.in", "other.in"));
    CHECK(has("a.events -> count.in"));
    CHECK(has("a.events -> other.in"));
    CHECK(has("b.events -> other.in"));
    CHECK_FALSE(has("b.events -> count.in"));
    REQUIRE(bench.reconnect("level.value", "loud.factor", "tone.amplitude"));
    CHECK(has("level.value -> tone.amplitude as linear"));
}

TEST_CASE("a new node stands in the patch without its wires, and runs when it has them") {
    const Folder folder;
    Workbench bench(choice_in(folder));
    const std::size_t running = bench.plan()->nodes.size();
    REQUIRE(bench.add_node("filter", "48 kHz") == "filter");
    CHECK(bench.editor().text().find("[nodes.filter]") != std::string::npos);
    REQUIRE(bench.unfinished().nodes.size() == 1);
    CHECK(bench.unfinished().nodes[0].lacks == "input 'in' has no wire");
    CHECK(bench.plan()->nodes.size() == running);
    const int shown = bench.picture().find("filter");
    REQUIRE(shown >= 0);
    CHECK_FALSE(bench.picture().nodes[static_cast<std::size_t>(shown)].lacks.empty());
    // Types are checked before it runs.
    CHECK_FALSE(bench.connect("level.value", "filter.in"));
    CHECK(bench.messages().back().text.find("takes a signal") != std::string::npos);
    CHECK_FALSE(bench.connect("loud.out", "filter.out"));
    CHECK(bench.objection("level.value", "filter.in"));
    REQUIRE(bench.connect("loud.out", "filter.in"));
    CHECK(bench.unfinished().empty());
    CHECK(bench.plan()->nodes.size() == running + 1);
    CHECK(bench.add_node("constant", "60 Hz") == "constant");
    for (int i = 0; i < 3; ++i) CHECK(bench.undo());
    CHECK(bench.editor().text() == voice);
    CHECK_FALSE(bench.undo());
}

TEST_CASE("what an unfinished node feeds waits with it, and a wire taken off returns by undo") {
    const Folder folder;
    Workbench bench(choice_in(folder));
    REQUIRE(bench.disconnect("loud.in"));
    CHECK(bench.unfinished().find("loud"));
    CHECK(bench.plan()->nodes.size() == 2);
    REQUIRE(bench.undo());
    REQUIRE(bench.remove("tone"));
    CHECK(bench.unfinished().find("loud"));
    CHECK(bench.picture().find("loud") >= 0);
    REQUIRE(bench.undo());
    CHECK(bench.editor().text() == voice);
    CHECK(bench.unfinished().empty());
}

TEST_CASE("a patch grows from nothing, is given a name, and its file compiles") {
    const Folder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path);
    const auto bench = Workbench::untitled(RunChoice{});
    std::filesystem::current_path(before);
    CHECK(bench->is_untitled());
    CHECK_FALSE(bench->plan());
    CHECK_FALSE(bench->is_broken());
    bench->run();
    CHECK(bench->messages().back().is_problem);
    CHECK_FALSE(bench->running());
    REQUIRE(bench->add_node("device_input", "1 kHz") == "device_input");
    REQUIRE(bench->add_node("sphere_contact", bench->lane_for("sphere_contact"), patch::PatchPlace{300.0, 40.0}) ==
            "sphere_contact");
    REQUIRE(bench->add_node("device_output", "1 kHz") == "device_output");
    CHECK(bench->plan()->nodes.size() == 1);
    CHECK(bench->picture().nodes.size() == 3);
    REQUIRE(bench->connect("device_input.pose", "sphere_contact.pose"));
    REQUIRE(bench->connect("sphere_contact.wrench", "device_output.wrench"));
    REQUIRE(bench->plan());
    CHECK(bench->plan()->nodes.size() == 3);
    REQUIRE(bench->set_device("simulated", "start_z", "60 mm"));
    CHECK_FALSE(bench->save());
    CHECK(bench->wants_name);
    REQUIRE(bench->save_as((folder.path / "ball").string()));
    CHECK_FALSE(bench->is_untitled());
    const std::string text = slurp(folder.path / "ball.toml");
    CHECK(text.find("sphere_contact = [300, 40]") != std::string::npos);
    CHECK(folder.tactus("check " + (folder.path / "ball.toml").string()).code == 0);
    while (bench->undo()) {
    }
    CHECK(bench->editor().text().empty());
}

TEST_CASE("a patch saved at the bench compiles to the plan that was shown") {
    const Folder folder;
    const RunChoice choice = choice_in(folder);
    Workbench bench(choice);
    REQUIRE(bench.set("tone", "frequency", "220 Hz"));
    REQUIRE(bench.add({"echo", "gain", "48 kHz", "", {{"factor", "2"}}, {{"loud.out", "echo.in", ""}}}));
    REQUIRE(bench.rename("loud", "louder"));
    REQUIRE(bench.save());
    const std::string text = slurp(choice.patch);
    CHECK(text == bench.editor().text());
    CHECK(text.find("# the way of the sound") != std::string::npos);
    CHECK(text.find("\"220 Hz\"   # a") != std::string::npos);
    patch::Problems problems;
    const std::optional<compile::Schedule> plan = read_plan(choice, problems);
    REQUIRE(plan);
    REQUIRE(plan->nodes.size() == bench.plan()->nodes.size());
    for (std::size_t n = 0; n < plan->nodes.size(); ++n) {
        const compile::ScheduleNode &a = plan->nodes[n], &b = bench.plan()->nodes[n];
        CHECK(a.name == b.name);
        CHECK(a.type == b.type);
        CHECK(a.group == b.group);
        for (const auto& [name, param] : a.params) CHECK(param->value == b.params.at(name)->value);
    }
    REQUIRE(plan->wires.size() == bench.plan()->wires.size());
    for (std::size_t w = 0; w < plan->wires.size(); ++w) {
        const compile::ScheduleWire &a = plan->wires[w], &b = bench.plan()->wires[w];
        CHECK((a.from_node == b.from_node && a.from_output == b.from_output && a.to_node == b.to_node &&
               a.to_input == b.to_input && a.mode == b.mode));
    }
}

TEST_CASE("a run follows its patch to another file: what is saved there counts and new sub-patches are found there",
          "[virtual]") {
    const test::VirtualClock clock;
    const Folder folder, elsewhere;
    Workbench bench(choice_in(folder));
    bench.run();
    const auto status = [&] {
        bench.tend();
        return bench.status();
    };
    REQUIRE(come_about([&] { return status()->time > 0.1; }));
    REQUIRE(bench.save_as((elsewhere.path / "moved.toml").string()));
    REQUIRE(bench.make_sub_patch({"loud"}, "part"));
    CHECK(std::filesystem::exists(elsewhere.path / "part.toml"));
    REQUIRE(come_about([&] { return status()->edits == 1; }));
    REQUIRE(bench.save());
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    bench.tend();
    const std::string text = bench.editor().text();
    // Another program saves the new file.
    elsewhere.write("moved.toml", text + "\n# saved elsewhere\n");
    REQUIRE(come_about([&] {
        bench.tend();
        return bench.editor().text().ends_with("# saved elsewhere\n");
    }));
    bench.stop();
    REQUIRE(come_about([&] { return bench.running()->is_over(); }));
}

TEST_CASE("edits at the bench reach the run: parameters as such, all else as a new plan, a pause as time that stands",
          "[virtual]") {
    const test::VirtualClock clock;
    const Folder folder;
    Workbench bench(choice_in(folder));
    bench.run();
    const auto status = [&] {
        bench.tend();
        return bench.status();
    };
    REQUIRE(come_about([&] { return status()->time > 0.1; }));
    REQUIRE(bench.set("tone", "frequency", "220 Hz"));
    REQUIRE(bench.connect("level.value", "loud.factor", "linear"));
    REQUIRE(come_about([&] { return status()->edits == 1; }));
    bench.undo();
    REQUIRE(come_about([&] { return status()->edits == 2; }));
    bench.pause(true);
    REQUIRE(come_about([&] { return status()->state == RunStatus::State::stands; }));
    const double stood = status()->time;
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    CHECK(status()->time == stood);
    bench.pause(false);
    REQUIRE(come_about([&] { return status()->time > stood + 0.05; }));
    REQUIRE(bench.save());
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    // What was saved runs already.
    CHECK(status()->edits == 2);
    bench.stop();
    REQUIRE(come_about([&] { return bench.running()->is_over(); }));
    CHECK(bench.status()->failure.empty());
    CHECK(bench.running()->summary_json().find("output_hash") != std::string::npos);
}

TEST_CASE("a file saved elsewhere is taken over by what runs, parameters that were turned among it, and can be undone",
          "[virtual]") {
    const test::VirtualClock clock;
    const Folder folder;
    const RunChoice choice = choice_in(folder);
    Workbench bench(choice);
    bench.run();
    const auto status = [&] {
        bench.tend();
        return bench.status();
    };
    REQUIRE(come_about([&] { return status()->time > 0.1; }));
    // Turned in the window, then written back from outside: the run must hear of it, though the patch it began with
    // says the same as the file does now.
    REQUIRE(bench.set("level", "number", "0.9"));
    const auto loudness = [&] {
        bench.observer()->watch("level.value", observe::Watch::latest);
        return bench.observer()->latest<double>("level.value").value_or(observe::Seen<double>{}).value;
    };
    REQUIRE(come_about([&] { return status(), loudness() == 0.9; }));
    folder.write("voice.toml", voice + "# from elsewhere\n");
    REQUIRE(come_about([&] { return status(), loudness() == 0.5; }));
    CHECK(bench.editor().text() == voice + "# from elsewhere\n");
    CHECK(status()->edits == 0);
    folder.write("voice.toml", voice + "[nodes.more]\ntype = \"constant\"\nrate = \"60 Hz\"\n");
    REQUIRE(come_about([&] { return status()->edits == 1; }));
    CHECK(bench.picture().find("more") >= 0);
    folder.write("voice.toml", voice + "oops");
    REQUIRE(come_about([&] { return status(), bench.is_broken(); }));
    CHECK(bench.undo());
    REQUIRE(bench.plan());
    CHECK_FALSE(bench.is_broken());
    CHECK(bench.picture().find("more") >= 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    CHECK(status()->edits == 1);
    CHECK(status()->state == RunStatus::State::runs);
}

TEST_CASE(
    "a bench without a run takes over a file changed elsewhere when it is to be saved, and then it can be saved") {
    const Folder folder;
    const RunChoice choice = choice_in(folder);
    Workbench bench(choice);
    REQUIRE(bench.set("tone", "frequency", "220 Hz"));
    const std::string mine = bench.editor().text();
    folder.write("voice.toml", voice + "# from elsewhere\n");
    CHECK_FALSE(bench.save());
    CHECK(bench.messages().back().text.find("undo") != std::string::npos);
    CHECK(bench.editor().text() == voice + "# from elsewhere\n");
    CHECK(slurp(choice.patch) == bench.editor().text());
    REQUIRE(bench.undo());
    CHECK(bench.editor().text() == mine);
    CHECK(bench.save());
    CHECK(slurp(choice.patch) == mine);
}

TEST_CASE("a bench without a run sees that a sub-patch was saved elsewhere, also one that was wrong meanwhile") {
    const Folder folder;
    const std::string part = R"([outputs]
out = "tone.signal"
[nodes.tone]
type = "sine"
rate = "outer"
frequency = "200 Hz"
)";
    const std::string louder = part + "amplitude = 0.25\n", wrong = part + "no_such_thing = 1\n";
    folder.write("part.toml", part);
    folder.write("whole.toml", R"(wires = ["voice.out -> half.in"]
[nodes.voice]
type = "patch:part.toml"
rate = "48 kHz"
[nodes.half]
type = "gain"
rate = "48 kHz"
factor = 0.5
)");
    RunChoice choice;
    choice.patch = (folder.path / "whole.toml").string();
    Workbench bench(choice);
    REQUIRE(bench.plan());
    const auto has_part = [&](const std::string& text) {
        bench.tend();
        return bench.plan() && bench.plan()->patch.parts.size() == 1 && bench.plan()->patch.parts[0].text == text;
    };
    REQUIRE(has_part(part));
    folder.write("part.toml", louder);
    REQUIRE(come_about([&] { return has_part(louder); }));
    CHECK(bench.messages().back().text.find("a sub-patch was saved") != std::string::npos);
    CHECK(bench.editor().is_saved());
    folder.write("part.toml", wrong);
    REQUIRE(come_about([&] { return bench.tend(), bench.is_broken(); }));
    folder.write("part.toml", part);
    REQUIRE(come_about([&] { return has_part(part); }));
    CHECK_FALSE(bench.is_broken());
}

TEST_CASE("a bench without a run sees that the file was saved elsewhere, and keeps its own edits beside it") {
    const Folder folder;
    const RunChoice choice = choice_in(folder);
    Workbench bench(choice);
    REQUIRE(bench.set("tone", "frequency", "220 Hz"));
    const std::string mine = bench.editor().text(), theirs = voice + "# from elsewhere\n";
    bench.tend();
    CHECK(bench.editor().text() == mine);
    folder.write("voice.toml", theirs);
    REQUIRE(come_about([&] { return bench.tend(), bench.editor().text() == theirs; }));
    CHECK(bench.editor().is_saved());
    const std::size_t told = bench.messages().size();
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    bench.tend();
    CHECK(bench.messages().size() == told);
    // A window that is closed now has lost nothing.
    CHECK_FALSE(bench.has_unsaved_edits());
    Workbench next(choice);
    next.find_kept_edits();
    REQUIRE(next.offer());
    CHECK(slurp(*next.offer()) == mine);
    REQUIRE(bench.undo());
    CHECK(bench.editor().text() == mine);
    REQUIRE(bench.save());
    // What was saved needs no copy any more.
    Workbench last(choice);
    last.find_kept_edits();
    CHECK_FALSE(last.offer());
}

TEST_CASE("two windows on one file: who saves second is told, and both texts are there") {
    const Folder folder;
    const RunChoice choice = choice_in(folder);
    Workbench first(choice), second(choice);
    REQUIRE(first.set("tone", "frequency", "220 Hz"));
    REQUIRE(second.set("tone", "frequency", "330 Hz"));
    const std::string of_first = first.editor().text(), of_second = second.editor().text();
    REQUIRE(first.save());
    CHECK_FALSE(second.save());
    CHECK(slurp(choice.patch) == of_first);
    CHECK(second.editor().text() == of_first);
    REQUIRE(second.undo());
    CHECK(second.editor().text() == of_second);
    REQUIRE(second.save());
    REQUIRE(come_about([&] { return first.tend(), first.editor().text() == of_second; }));
}

TEST_CASE("record pressed while a patch runs leaves the run alone and makes a take that repeats it", "[virtual]") {
    const test::VirtualClock clock;
    const Folder folder;
    Workbench bench(choice_in(folder));
    CHECK(bench.take().empty());
    bench.run();
    const auto status = [&] {
        bench.tend();
        return bench.status();
    };
    REQUIRE(come_about([&] { return status()->time > 0.3; }));
    CHECK_FALSE(bench.is_recording());
    REQUIRE(bench.set("tone", "frequency", "220 Hz"));
    bench.record(true);
    REQUIRE(come_about([&] { return status()->is_recording; }));
    CHECK(bench.runs() == 1);
    const double pressed = status()->time;
    REQUIRE(come_about([&] { return status()->time > pressed + 0.3; }));
    REQUIRE(bench.connect("level.value", "loud.factor", "linear"));
    REQUIRE(come_about([&] { return status()->edits == 1; }));
    bench.record(false);
    REQUIRE(come_about([&] { return !status()->is_recording; }));
    REQUIRE(come_about([&] { return status()->time > pressed + 1.0; }));
    bench.stop();
    REQUIRE(come_about([&] { return bench.running()->is_over(); }));
    CHECK(bench.status()->failure.empty());
    CHECK(bench.take() == folder.path / "voice-take-1");
    const take::Take take = take::Take::load(bench.take());
    CHECK(take.streams.size() == 3);
    const TakeFeed feed(take);
    REQUIRE(feed.recorded().size() == 1);
    CHECK(feed.recorded()[0].low > 0.25);
    CHECK(feed.recorded()[0].high < pressed + 1.0);
    const test::Outcome again = folder.tactus("replay " + bench.take().string() + " --json");
    INFO(again.out << again.err);
    CHECK(again.code == 0);
    // Nothing is left of what was kept in case.
    for (const auto& entry : std::filesystem::directory_iterator(folder.path / "out"))
        CHECK(entry.path().filename().string().find("journal") == std::string::npos);
    // Once more: another run, recorded from its beginning.
    bench.record(true);
    CHECK(bench.take() == folder.path / "voice-take-2");
    REQUIRE(come_about([&] { return status()->time > 0.1; }));
    CHECK(bench.is_recording());
}

TEST_CASE("an output that two look at stays looked at when one of them turns away", "[virtual]") {
    const test::VirtualClock clock;
    const Folder folder;
    Workbench bench(choice_in(folder));
    bench.run();
    REQUIRE(come_about([&] { return bench.tend(), bench.status()->time > 0.1; }));
    observe::Observer& observer = *bench.observer();
    const int other = 0;
    observer.watch("level.value", observe::Watch::latest, &other);
    {
        LiveFeed feed(bench.observer());
        feed.follow({"level.value"}, {});
        feed.follow({}, {"level.value"});
        CHECK(come_about([&] {
            feed.follow({}, {"level.value"});
            return feed.trace("level.value") && feed.trace("level.value")->times.size() > 3;
        }));
        feed.follow({}, {});
    }
    const auto when = [&] { return observer.latest<double>("level.value")->when; };
    const Flicks then = when();
    CHECK(come_about([&] { return when() > then; }));
}

TEST_CASE("a run whose patch is broken ends with the reason and leaves the bench to mend it") {
    const Folder folder;
    RunChoice choice = choice_in(folder);
    folder.write("voice.toml", voice + "[nodes.bad]\ntype = \"gian\"\nrate = \"48 kHz\"\n");
    Workbench bench(choice);
    CHECK(bench.is_broken());
    CHECK(bench.messages().back().text.find("did you mean 'gain'") != std::string::npos);
    bench.run();
    REQUIRE(come_about([&] { return bench.running()->is_over(); }));
    CHECK(bench.status()->failure.find("gian") != std::string::npos);
}

TEST_CASE("a place on the bone becomes the site of the saw as one edit that can be undone", "[slow]") {
    const Folder folder;
    ::setenv("TACTUS_LIBRARY", test::library_folder().c_str(), 1);
    RunChoice choice = choice_in(folder);
    choice.patch = "saw-training";
    choice.overrides.settings = {"place.site=1 mm, 2 mm, 3 mm"};
    Workbench bench(choice);
    REQUIRE(bench.can_cut());
    const std::string before = bench.editor().text();
    REQUIRE(bench.cut_at(Vec3(0.0123456, -0.05, 1.25)));
    const std::string& text = bench.editor().text();
    CHECK(text.find("\"12.35 mm, -50 mm, 1250 mm\"") != std::string::npos);
    CHECK(text.find("find_site = false") != std::string::npos);
    CHECK(text.find("\"0, 0, 0\"") != std::string::npos);
    bench.undo();
    CHECK(bench.editor().text() == before);
    CHECK_FALSE(bench.editor().can_undo());

    Workbench voice_bench(choice_in(folder));
    CHECK_FALSE(voice_bench.can_cut());
    CHECK_FALSE(voice_bench.cut_at(Vec3(0.0)));
    CHECK(voice_bench.messages().back().is_problem);
    CHECK(voice_bench.editor().text() == voice);
}
