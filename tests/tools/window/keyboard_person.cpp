// SPDX-License-Identifier: Apache-2.0
// Somebody without a mouse.
#include "assets/plan/plan_file.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/window/eyes.hpp"

#include <cmath>
#include <future>

using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

/// Does one thing through the list of commands.
void command(Person& person, const Eyes& eyes, const std::string& words) {
    const auto is_open = [&] { return eyes.spots().contains("command"); };
    person.chord({"Control_L"}, "p");
    REQUIRE(sees(is_open));
    person.type(words);
    person.tap("Return");
    CHECK(sees([&] { return !is_open(); }));
    eyes.look_again();
}

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("the keyboard alone opens an example, starts and ends it, changes a value, saves it and leaves",
          "[display]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    folder.write("other.toml",
                 "wires = [\"zebra.pose -> out.in\"]\n[devices.simulated]\ndriver = \"simulated\"\n"
                 "[nodes.zebra]\ntype = \"device_input\"\nrate = \"1 kHz\"\n"
                 "[nodes.out]\ntype = \"record\"\nrate = \"1 kHz\"\nfile = \"out.csv\"\n");
    folder.write("script", watching_script("size 1000 700\n", 600.0));
    auto done = std::async(std::launch::async,
                           [&] { return on(display, folder, "view --view-scale 1 --view-script script", 700); });
    REQUIRE(person.sees_window("Tactus", 30.0));
    const Eyes eyes{folder.path};
    const auto shows = [&](const std::string& control) { return sees([&] { return eyes.spots().contains(control); }); };
    // Of the examples, the first rows fit into this window.
    REQUIRE(shows("example burr-training"));
    // The pointer is somewhere else.
    person.move(1500.0, 1100.0);
    command(person, eyes, "open touch-sphere");
    REQUIRE(shows("hand_out"));
    keep(person, "keyboard-1-opened");
    person.tap("F5");
    REQUIRE(shows("stop"));
    eyes.look_again();
    // A menu by its arrows: Run is the third.
    person.tap("F10");
    eyes.look_again();
    for (const char* key : {"Down", "Down", "Right"}) {
        person.tap(key);
        eyes.look_again();
    }
    eyes.look_again();
    keep(person, "keyboard-2-menu");
    CHECK(shows("menu End the run"));
    for (int n = 0; n < 3; ++n) {
        person.tap("Escape");
        eyes.look_again();
    }
    eyes.look_again();
    command(person, eyes, "end the run");
    REQUIRE(shows("run"));
    command(person, eyes, "go to hand_out");
    command(person, eyes, "set hand_out max_force");
    eyes.look_again();
    keep(person, "keyboard-3-value");
    person.type("7.25 N");
    person.tap("Return");
    eyes.look_again();
    // Who leaves is asked, and may stay.
    person.chord({"Control_L"}, "q");
    CHECK(shows("cancel closing"));
    person.tap("Escape");
    CHECK(sees([&] { return !eyes.spots().contains("cancel closing"); }));
    person.chord({"Control_L", "Shift_L"}, "s");
    REQUIRE(shows("file name"));
    eyes.look_again();
    // In a field all is chosen, and what is typed replaces it.
    person.chord({"Control_L"}, "a");
    person.type("mine");
    keep(person, "keyboard-4-save-as");
    person.tap("Return");
    CHECK(sees([&] { return fs::exists(folder.path / "mine.toml"); }));
    const std::string text = slurp(folder.path / "mine.toml");
    INFO(text);
    CHECK(text.find("7.25 N") != std::string::npos);
    eyes.look_again();
    // A wrong name is typed anew, and the arrows go through the files.
    person.chord({"Control_L"}, "o");
    REQUIRE(shows("file other.toml"));
    person.type("nothing");
    person.tap("Return");
    eyes.look_again();
    person.chord({"Control_L"}, "a");
    person.type("ot");
    person.tap("Down");
    eyes.look_again();
    keep(person, "keyboard-5-files");
    person.tap("Return");
    CHECK(shows("zebra"));
    // It leaves although the patch runs: the window asks, and a key answers.
    person.tap("F5");
    REQUIRE(shows("stop"));
    eyes.look_again();
    person.chord({"Control_L"}, "q");
    eyes.look_again();
    keep(person, "keyboard-6-leaves");
    person.tap("Right");
    eyes.look_again();
    person.tap("Left");
    eyes.look_again();
    keep(person, "keyboard-7-answer");
    person.tap("Return");
    const bool left = done.wait_for(std::chrono::seconds(15)) == std::future_status::ready;
    CHECK(left);
    if (!left) interrupt(folder.path);
    const Outcome outcome = done.get();
    INFO(outcome.err);
    CHECK(outcome.code == 0);
}

TEST_CASE("the keyboard alone goes to other places in a list of files", "[display]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    fs::create_directories(folder.path / "inner");
    folder.write("inner/deep.toml", "");
    folder.write("script", watching_script("size 1000 700\n", 600.0));
    auto done = std::async(std::launch::async,
                           [&] { return on(display, folder, "view --view-scale 1 --view-script script", 700); });
    REQUIRE(person.sees_window("Tactus", 30.0));
    const Eyes eyes{folder.path};
    const auto shows = [&](const std::string& control) { return sees([&] { return eyes.spots().contains(control); }); };
    REQUIRE(shows("New patch"));
    person.move(1500.0, 1100.0);
    person.chord({"Control_L"}, "o");
    REQUIRE(shows("file inner"));
    // The third place is the library, the second the folder where the command works.
    person.chord({"Alt_L"}, "3");
    CHECK(shows("file fragments.toml"));
    keep(person, "keyboard-8-places");
    person.chord({"Alt_L"}, "2");
    REQUIRE(shows("file inner"));
    person.type("inner");
    person.tap("Return");
    CHECK(shows("file deep.toml"));
    person.chord({"Alt_L"}, "Up");
    CHECK(shows("file inner"));
    person.tap("Escape");
    CHECK(sees([&] { return !eyes.spots().contains("file name"); }));
    interrupt(folder.path);
    done.wait();
}

TEST_CASE("the keyboard alone moves and turns the hand, wherever the pointer is", "[display]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    folder.write("touch.toml", R"(wires = ["hand.pose -> ball.pose", "ball.wrench -> out.wrench", "hand.pose -> log.in"]
[devices.mouse]
driver = "mouse"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
[nodes.out]
type = "device_output"
rate = "1 kHz"
[nodes.log]
type = "record"
rate = "1 kHz"
file = "hand.csv"
)");
    folder.write("script", watching_script("size 1000 700\n", 600.0));
    auto done = std::async(std::launch::async, [&] {
        return on(display, folder, "run touch.toml --view --view-scale 1 --view-script script --audio none --out out",
                  700);
    });
    REQUIRE(person.sees_window("Tactus", 60.0));
    const Eyes eyes{folder.path};
    REQUIRE(sees([&] { return eyes.spots().contains("trigger (T)"); }));
    person.move(1500.0, 1100.0);
    const auto hand = [&] { return eyes.last_row("out/hand.csv"); };
    REQUIRE(sees([&] { return hand().size() >= 8; }));
    Person::wait(3.0);
    const std::vector<double> before = hand();
    const auto moved = [&] {
        const std::vector<double> now = hand();
        return std::hypot(now[1] - before[1], now[2] - before[2], now[3] - before[3]);
    };
    const auto is_turned = [&] {
        const std::vector<double> now = hand();
        double same = 0.0;
        for (std::size_t i = 4; i < 8; ++i) same += now[i] * before[i];
        return std::abs(same) < 0.9995;
    };
    // Half a millimetre each.
    for (int i = 0; i < 10; ++i) person.tap("Up");
    CHECK(sees([&] { return moved() > 4e-3; }));
    CHECK(moved() < 8e-3);
    CHECK_FALSE(is_turned());
    person.key("Shift_L", true);
    for (int i = 0; i < 10; ++i) person.tap("Left");
    person.key("Shift_L", false);
    CHECK(sees(is_turned));
    keep(person, "keyboard-9-hand");
    interrupt(folder.path);
    done.wait();
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("the keyboard alone chooses fragments of a plan and groups them", "[display][live]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    folder.write("script", watching_script("size 1000 700\n", 600.0));
    auto done = std::async(std::launch::async, [&] {
        return on(display, folder,
                  "run planning-trauma --view --layout plan --view-scale 1 --view-script script --set "
                  "hand.device=mouse --audio none --out out",
                  700);
    });
    REQUIRE(person.sees_window("Tactus", 60.0));
    const Eyes eyes{folder.path};
    REQUIRE(sees([&] { return eyes.spots().contains("part fragment_02"); }));
    REQUIRE(sees([&] { return fs::exists(folder.path / "out/case.plan.json"); }));
    // A run that ticks: before, the list is that of the preview.
    REQUIRE(sees([&] { return !eyes.last_row("out/fragment.csv").empty(); }));
    REQUIRE(sees([&] { return eyes.spots().contains("trigger (T)"); }));
    eyes.look_again();
    person.move(1500.0, 1100.0);
    command(person, eyes, "choose fragment_07");
    command(person, eyes, "choose fragment_02");
    keep(person, "keyboard-10-chosen");
    command(person, eyes, "group the chosen");
    CHECK(sees([&] {
        return tactus::plan::state_of(tactus::plan::load_case_plan(folder.path / "out/case.plan.json"))
            .arrangement.move_together(1, 6);
    }));
    keep(person, "keyboard-11-grouped");
    interrupt(folder.path);
    done.wait();
}
