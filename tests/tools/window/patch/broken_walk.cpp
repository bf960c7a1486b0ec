// SPDX-License-Identifier: Apache-2.0
// Somebody opens a patch with three errors and repairs it with the mouse and the keyboard.
#include "tests/tools/window/broken_patch.hpp"
#include "tests/tools/window/walk.hpp"

using namespace tactus::test;
namespace fs = std::filesystem;

TEST_CASE("a person opens a patch with three errors, repairs each in its way, saves it and runs it", "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "errors");
        if (!walk.is_possible()) return;
        Person& person = walk.person;
        walk.folder.write("broken.toml", broken_patch);
        walk.start("view broken.toml", 240.0);
        REQUIRE(walk.waits_for("error 3"));
        walk.keep("open");
        // The error leads to its place.
        walk.press("error 2", "panel errors");
        CHECK(walk.waits_for("ball"));
        Person::wait(0.5);
        walk.keep("place");
        // A button with the name that was meant.
        REQUIRE(walk.until([&] { return walk.shows_text("type = \"sine\""); },
                           [&] { walk.press("error 3 correct", "panel errors"); }));
        REQUIRE(walk.waits_while("error 3"));
        // The line of the text.
        REQUIRE(walk.until([&] { return walk.shows_text("ball.penetration -> depth.in"); },
                           [&] {
                               walk.press("error 1 line", "panel errors");
                               person.chord({"Control_L"}, "a");
                               person.type("  \"ball.penetration -> depth.in\",");
                               person.tap("Return");
                           }));
        REQUIRE(walk.waits_while("error 2"));
        // The setting is removed, and has its default.
        REQUIRE(walk.until([&] { return !walk.shows_text("N/m/s"); },
                           [&] { walk.press("error 1 reset", "panel errors"); }));
        CHECK(walk.waits_while("panel errors"));
        walk.keep("sound");
        person.chord({"Control_L"}, "s");
        CHECK(sees([&] { return slurp(walk.folder.path / "broken.toml").find("sine") != std::string::npos; }));
        CHECK(walk.until([&] { return walk.shows("stop"); }, [&] { person.tap("F5"); }));
        walk.stop();
        const Outcome checked = on(walk.display, walk.folder, "check broken.toml");
        INFO(checked.err);
        CHECK(checked.code == 0);
    }
}

TEST_CASE("a repair by another program clears the list of errors in the window", "[display]") {
    Walk walk(small_window, "repair");
    if (!walk.is_possible()) return;
    walk.folder.write("broken.toml", broken_patch);
    walk.start("view broken.toml", 120.0);
    REQUIRE(walk.waits_for("error 1"));
    walk.folder.write("broken.toml", sound_patch);
    CHECK(walk.waits_while("panel errors"));
    CHECK(walk.shows("speaker"));
    walk.stop();
}
