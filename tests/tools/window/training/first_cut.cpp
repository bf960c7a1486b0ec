// SPDX-License-Identifier: Apache-2.0
// Somebody who has read nothing does what is written in the scene, and cuts bone within a minute.
#include "tests/tools/window/walk.hpp"

#include <chrono>

using namespace tactus::test;

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a trainee who only follows the words in the scene cuts bone within a minute", "[display][live]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "first-cut");
        if (!walk.is_possible()) return;
        walk.start("run saw-task --view --layout train --set hand.device=mouse --audio none --out out --json", 240.0);
        const char* const directions[] = {"right", "left", "up", "down"};
        const auto hint = [&]() -> std::string {
            for (const char* direction : directions)
                if (walk.shows(std::string("hint ") + direction)) return direction;
            return {};
        };
        REQUIRE(sees([&] { return !hint().empty(); }));
        walk.keep("hint");
        const auto begin = std::chrono::steady_clock::now();
        const std::string direction = hint();
        const Spot scene = walk.eyes.spot("scene picture");
        double x = 0.5 * (scene.left + scene.right), y = 0.5 * (scene.top + scene.bottom);
        const double step = 2.0,
                     right = direction == "right"  ? 1.0
                             : direction == "left" ? -1.0
                                                   : 0.0,
                     down = direction == "down" ? 1.0
                            : direction == "up" ? -1.0
                                                : 0.0;
        Person& person = walk.person;
        person.move(x, y);
        Person::wait(0.3);
        person.key("t", true);
        person.button(1, true);
        const auto removed_mm3 = [&] {
            const std::vector<double> row = walk.eyes.last_row("out/task.csv");
            return row.size() < 13 ? 0.0 : row[12] * 1e9;
        };
        const auto elapsed = [&] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        };
        while (removed_mm3() < 1.0 && elapsed() < 60.0) {
            Person::wait(0.15);
            person.move(x += right * step, y += down * step);
        }
        person.button(1, false);
        person.key("t", false);
        walk.keep("cut");
        INFO(direction << ", " << elapsed() << " s");
        CHECK(removed_mm3() >= 1.0);
        // What is known is not written any more.
        CHECK(sees([&] { return hint().empty(); }));
        walk.stop();
    }
}
