// SPDX-License-Identifier: Apache-2.0
// A person takes the hand of a patch that moves by itself, feels with it, hears the force and gives it back.
#include "tests/tools/window/walk.hpp"

#include <cmath>

using namespace tactus::test;

namespace {

/// The length of the vector in the first three columns after the time; 0 without a row.
double length_in(const Eyes& eyes, const std::string& table) {
    const std::vector<double> row = eyes.last_row(table);
    return row.size() < 4 ? 0.0 : std::hypot(row[1], row[2], row[3]);
}

}  // namespace

TEST_CASE("a person takes the hand of a patch with the mouse and feels and gives it back", "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "hand");
        if (!walk.is_possible()) return;
        walk.start("run touch-sphere --view --layout plan --audio none --out out", 150.0);
        REQUIRE(walk.waits_for("Take the hand"));
        walk.press("Take the hand");
        REQUIRE(walk.waits_for("trigger (T)"));
        // Each run in one window has a folder of its own.
        const auto force_N = [&] { return length_in(walk.eyes, "out-2/force.csv"); };
        CHECK(sees([&] { return !walk.eyes.last_row("out-2/pose.csv").empty(); }));
        Person::wait(2.0);
        const std::vector<double> before = walk.eyes.last_row("out-2/pose.csv");
        const Spot scene = walk.eyes.spot("scene picture");
        const double x = 0.5 * (scene.left + scene.right), step = (scene.bottom - scene.top) / 60.0;
        double y = 0.5 * (scene.top + scene.bottom);
        walk.person.move(x, y);
        Person::wait(0.3);
        walk.person.button(1, true);
        double max_N = 0.0;
        while (max_N < 1.2 && y < scene.bottom - 10.0) {
            walk.person.move(x, y += step);
            Person::wait(0.4);
            max_N = std::max(max_N, force_N());
        }
        walk.keep("pushes");
        walk.person.button(1, false);
        const std::vector<double> after = walk.eyes.last_row("out-2/pose.csv");
        REQUIRE(after.size() >= 4);
        // Against 1 N/mm.
        CHECK(std::hypot(after[1] - before[1], after[2] - before[2], after[3] - before[3]) > 1e-3);
        CHECK(max_N > 1.2);

        walk.press("Give the hand back");
        CHECK(walk.waits_for("Take the hand"));
        CHECK(walk.waits_while("trigger (T)"));
        CHECK_FALSE(walk.shows_text("mouse"));
        CHECK(walk.stop().code == 0);
    }
}

TEST_CASE("a person hears the force by a command and ends that by the same", "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "hear");
        if (!walk.is_possible()) return;
        walk.start("run touch-sphere --view --audio file --out out", 120.0);
        REQUIRE(walk.waits_for("record"));
        CHECK(walk.until([&] { return walk.shows_text("force_tone"); }, [&] { walk.command("hear the force"); }));
        walk.keep("hears");
        CHECK(walk.until([&] { return !walk.shows_text("force_tone"); }, [&] { walk.command("hear the force"); }));
        walk.stop();
    }
}
