// SPDX-License-Identifier: Apache-2.0
// A trainee with a mouse and a keyboard saws the jaw through and reads the score.
#include "tests/tools/window/walk.hpp"

#include <glm/geometric.hpp>

#include <chrono>
#include <cmath>

using namespace tactus;
using namespace tactus::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// The columns of task.csv, after the time.
struct Attempt {
    double into = 0.0;   ///< m, how far the tooth edge is along the feed
    double force = 0.0;  ///< N, on the hand
    bool touches = false;
    double removed_mm3 = 0.0;
};

Attempt attempt_of(const Eyes& eyes) {
    const std::vector<double> row = eyes.last_row("out/task.csv");
    if (row.size() < 13) return {};
    return {row[2], std::hypot(row[8], row[9], row[10]), row[11] > 0.5, row[12] * 1e9};
}

/// Letters in a box: pixels that differ from the panel behind.
int letters_in(const Picture& seen, const Spot& box) {
    int count = 0;
    for (int y = static_cast<int>(box.top); y < std::min(static_cast<int>(box.bottom), seen.height); ++y)
        for (int x = static_cast<int>(box.left); x < std::min(static_cast<int>(box.right), seen.width); ++x)
            count += seen.at(x, y, 0) > 0x80 && seen.at(x, y, 1) > 0x80;
    return count;
}

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a trainee with a mouse saws the jaw through and reads the score", "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "saw");
        if (!walk.is_possible()) return;
        Person& person = walk.person;
        walk.start("run saw-task --view --layout train --set hand.device=mouse --audio none --out out --json", 480.0);
        REQUIRE(walk.waits_for("trigger (T)"));
        Person::wait(3.0);
        walk.keep("begin");
        const Spot scene = walk.eyes.spot("scene picture");
        CHECK(scene.right <= window.width);
        // From the side of the blade: to the right is into the bone.
        const double y = 0.5 * (scene.top + scene.bottom), step = (scene.bottom - scene.top) / 450.0;
        double x = 0.4 * (scene.left + scene.right);
        person.move(x, y);
        Person::wait(0.3);
        person.tap("3");
        walk.keep("side");
        person.key("t", true);
        person.button(1, true);
        constexpr double behind_the_jaw = 11e-3, pressing_N = 7.0, patience_s = 170.0;
        Attempt now;
        bool is_half = false;
        const auto begin = std::chrono::steady_clock::now();
        const auto is_patient = [&] {
            return std::chrono::steady_clock::now() - begin < std::chrono::duration<double>(patience_s);
        };
        while (is_patient() && !(now.into > behind_the_jaw && !now.touches)) {
            Person::wait(0.15);
            now = attempt_of(walk.eyes);
            // A person waits while the meter is near its limit.
            if (now.force < pressing_N && x < scene.right - 10.0) person.move(x += step, y);
            if (!is_half && now.removed_mm3 > 100.0) {
                is_half = true;
                walk.keep("half");
            }
        }
        person.button(1, false);
        person.key("t", false);
        INFO(fmt::format("{:.1f} mm into the jaw", 1e3 * now.into));
        // Forces of a mouse are not felt, and do not fade when the machine is late.
        CHECK_FALSE(walk.shows("state of forces"));
        CHECK(now.into > behind_the_jaw);
        walk.keep("through");
        walk.press("end");
        REQUIRE(walk.waits_for("score"));
        walk.keep("score");
        const Spot score = walk.eyes.spot("score"), again = walk.eyes.spot("again");
        CHECK(score.top > again.bottom);
        CHECK(score.bottom < window.height);
        CHECK(letters_in(person.look(), score) > 1000);
        walk.press("again");
        REQUIRE(walk.waits_for("end"));
        walk.keep("again");
        walk.stop();
        const Outcome scored = on(walk.display, walk.folder, "score out --json");
        INFO(scored.out << scored.err);
        REQUIRE(scored.code == 0);
        const json said = json::parse(scored.out);
        // Reported only for a bone that is severed in the plane of the cut.
        CHECK(said["breakthrough"]["depth_mm"].is_number());
        CHECK(said["under_mm3"].get<double>() < 5.0);
        CHECK(said["spared"][0]["injured_mm3"].get<double>() > 0.0);
        CHECK(said["force"]["shown"].get<double>() > 0.0);
    }
}
