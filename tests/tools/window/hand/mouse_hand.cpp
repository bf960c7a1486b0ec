// SPDX-License-Identifier: Apache-2.0
// A person with a mouse and a keyboard, and nothing else.
#include "assets/file/whole_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/window/person.hpp"

#include <functional>
#include <future>
#include <sstream>

using namespace tactus::test;
using nlohmann::json;

namespace {

std::future<Outcome> begin(const VirtualDisplay& display, const Folder& folder, const std::string& arguments) {
    return std::async(std::launch::async, [&display, &folder, arguments] { return on(display, folder, arguments); });
}

/// Samples of a scope's file that are not zero, and all.
std::pair<int, int> pressed_in(const std::filesystem::path& csv) {
    std::istringstream lines(tactus::file::read_whole_file(csv));
    std::string line;
    std::getline(lines, line);
    int pressed = 0, all = 0;
    for (; std::getline(lines, line); ++all) pressed += std::stod(line.substr(line.rfind(',') + 1)) > 0.5;
    return {pressed, all};
}

/// Holds a key of the hand, leaves the window and comes back with the key still held.
void check_that_leaving_lets_go(const std::function<void(Person&)>& leave,
                                const std::function<void(Person&)>& return_to) {
    NEEDS_PERSON(person, display)
    const Folder folder;
    folder.write("script", R"(size 800 600
scope hand.trigger
frames 12
until 7
export 0 held.csv
wait 10
export 0 left.csv
stop
until over
close
)");
    auto done = begin(display, folder,
                      "run touch-sphere --view --view-script script --set hand.device=mouse --audio none --out out "
                      "--seconds 60 --json");
    REQUIRE(person.sees_window("Tactus", 30.0));
    Person::wait(2.0);
    person.move(600.0, 300.0);
    person.key("t", true);
    // Pressed anew now and then: a busy machine's window lets go of what is held when it is silent for 1 s.
    for (int i = 0; i < 60 && !fs::exists(folder.path / "held.csv"); ++i) {
        person.key("t", false);
        person.key("t", true);
        Person::wait(1.1);
    }
    // Away and back, the key still held: what was pressed just before counts no more, however slow pictures are.
    person.key("t", false);
    person.key("t", true);
    leave(person);
    Person::wait(0.5);
    return_to(person);
    const Outcome outcome = done.get();
    person.key("t", false);
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(pressed_in(folder.path / "held.csv").first > 0);
    const auto [still_pressed, left] = pressed_in(folder.path / "left.csv");
    INFO("of " << left << " samples\n" << tactus::file::read_whole_file(folder.path / "left.csv").substr(0, 300));
    CHECK(still_pressed == 0);
    CHECK(left > 100);
}

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("who leaves the window lets go of the hand and its buttons", "[display][slow]") {
    check_that_leaving_lets_go([](Person& person) { person.move(1500.0, 1000.0); },
                               [](Person& person) { person.move(600.0, 300.0); });
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("who comes back to the window with a key held presses it anew", "[display][slow]") {
    check_that_leaving_lets_go([](Person& person) { person.take_keyboard(); },
                               [](Person& person) { person.give_keyboard("Tactus"); });
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a person with a mouse saws into the jaw, and the take repeats it", "[display]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    folder.write("script", R"(size 800 600
until 19
screenshot sawn.png
stop
until over
close
)");
    auto done = begin(display, folder,
                      "run saw-training --view --view-script script --set hand.device=mouse --audio none --out out "
                      "--record take --seconds 60 --json");
    REQUIRE(person.sees_window("Saw training", 30.0));
    Person::wait(3.0);
    person.key("t", true);
    // In the middle of the scene's picture, down through the bone.
    person.drag(620.0, 180.0, 620.0, 300.0, 13.0);
    person.key("t", false);
    const Outcome outcome = done.get();
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json summary = json::parse(outcome.out);
    INFO(outcome.out);
    // Also on a machine that is late: nobody feels the force of a mouse.
    CHECK(summary["carve"]["removed_mm3"].get<double>() > 20.0);
    check_picture(folder.path / "sawn.png", 800, 600);
    const Outcome again = on(display, folder, "replay take --json");
    INFO(again.out << again.err);
    CHECK(again.code == 0);
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("'try' runs the saw in a window with the mouse as hand", "[display][slow]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    const Outcome tried = on(display, folder, "try --seconds 2 --out tried");
    INFO(tried.out << tried.err);
    CHECK(tried.code == 0);
    const json summary = json::parse(slurp(folder.path / "tried/summary.json"));
    CHECK(summary["patch"] == "Saw training");
    CHECK(summary["force"]["felt_mean_N"] == 0.0);  // the hand rests, and nobody feels the force of a mouse
    CHECK(summary["force"]["energy_cap"] == "not needed");  // nor has it motors, unlike the hand of the patch
}

TEST_CASE("a mouse needs a window", "[display]") {
    NEEDS_DISPLAY(display)
    const Folder folder;
    for (const char* verb : {"run saw-training --seconds 1 --audio none", "render saw-training --seconds 1"}) {
        const Outcome refused = on(display, folder, std::string(verb) + " --set hand.device=mouse --out out");
        INFO(refused.err);
        CHECK(refused.code == 2);
        CHECK(refused.err.find("is a hand at a window; use 'tactus run PATCH --view'") != std::string::npos);
    }
    CHECK(on(display, folder, "check saw-training --set hand.device=mouse").code == 0);
}
