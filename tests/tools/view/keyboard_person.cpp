// SPDX-License-Identifier: Apache-2.0
// Somebody without a mouse.
#include "tests/support/places.hpp"
#include "tests/tools/view/eyes.hpp"

#include <future>

using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

/// Does one thing through the list of commands.
void command(Person& person, const std::string& words) {
    person.chord({"Control_L"}, "p");
    Person::wait(1.2);
    person.type(words);
    Person::wait(1.2);
    person.tap("Return");
    Person::wait(0.5);
}

}  // namespace

TEST_CASE("the keyboard alone opens an example, starts and ends it, changes a value, saves it and leaves",
          "[display][live]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    folder.write("other.toml",
                 "wires = [\"zebra.pose -> out.in\"]\n[devices.simulated]\ndriver = \"simulated\"\n"
                 "[nodes.zebra]\ntype = \"device_input\"\nrate = \"1 kHz\"\n"
                 "[nodes.out]\ntype = \"record\"\nrate = \"1 kHz\"\nfile = \"out.csv\"\n");
    folder.write("script", watching_script("size 1000 700\n", 120.0));
    auto done = std::async(std::launch::async,
                           [&] { return on(display, folder, "view --view-scale 1 --view-script script", 230); });
    REQUIRE(person.sees_window("Tactus", 30.0));
    const Eyes eyes{folder.path};
    const auto shows = [&](const std::string& control) { return sees([&] { return eyes.spots().contains(control); }); };
    REQUIRE(shows("example touch-sphere"));
    // The pointer is somewhere else.
    person.move(1500.0, 1100.0);
    command(person, "open touch-sphere");
    REQUIRE(shows("hand_out"));
    keep(person, "keyboard-1-opened");
    person.tap("F5");
    REQUIRE(shows("stop"));
    Person::wait(1.5);
    // A menu by its arrows: Run is the third.
    person.tap("F10");
    Person::wait(1.2);
    for (const char* key : {"Down", "Down", "Right"}) {
        person.tap(key);
        Person::wait(0.6);
    }
    Person::wait(1.2);
    keep(person, "keyboard-2-menu");
    CHECK(shows("menu End the run"));
    for (int n = 0; n < 3; ++n) {
        person.tap("Escape");
        Person::wait(0.4);
    }
    Person::wait(1.2);
    command(person, "end the run");
    REQUIRE(shows("run"));
    command(person, "go to hand_out");
    command(person, "set hand_out max_force");
    Person::wait(1.2);
    keep(person, "keyboard-3-value");
    person.type("7.25 N");
    person.tap("Return");
    Person::wait(0.5);
    // Who leaves is asked, and may stay.
    person.chord({"Control_L"}, "q");
    CHECK(shows("cancel closing"));
    person.tap("Escape");
    CHECK(sees([&] { return !eyes.spots().contains("cancel closing"); }));
    person.chord({"Control_L", "Shift_L"}, "s");
    REQUIRE(shows("file name"));
    Person::wait(1.2);
    // In a field all is chosen, and what is typed replaces it.
    person.chord({"Control_L"}, "a");
    person.type("mine");
    keep(person, "keyboard-4-save-as");
    person.tap("Return");
    CHECK(sees([&] { return fs::exists(folder.path / "mine.toml"); }));
    const std::string text = slurp(folder.path / "mine.toml");
    INFO(text);
    CHECK(text.find("7.25 N") != std::string::npos);
    Person::wait(1.2);
    // A wrong name is typed anew, and the arrows go through the files.
    person.chord({"Control_L"}, "o");
    REQUIRE(shows("file other.toml"));
    person.type("nothing");
    person.tap("Return");
    Person::wait(1.2);
    person.chord({"Control_L"}, "a");
    person.type("ot");
    person.tap("Down");
    Person::wait(0.8);
    keep(person, "keyboard-5-files");
    person.tap("Return");
    CHECK(shows("zebra"));
    // It leaves although the patch runs: the window asks, and a key answers.
    person.tap("F5");
    REQUIRE(shows("stop"));
    Person::wait(1.0);
    person.chord({"Control_L"}, "q");
    Person::wait(1.2);
    keep(person, "keyboard-6-leaves");
    person.tap("Right");
    Person::wait(0.3);
    person.tap("Left");
    Person::wait(1.2);
    keep(person, "keyboard-7-answer");
    person.tap("Return");
    const bool left = done.wait_for(std::chrono::seconds(15)) == std::future_status::ready;
    CHECK(left);
    if (!left) interrupt(folder.path);
    const Outcome outcome = done.get();
    INFO(outcome.err);
    CHECK(outcome.code == 0);
}
