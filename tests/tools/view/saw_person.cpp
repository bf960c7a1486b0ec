// SPDX-License-Identifier: Apache-2.0
// A trainee with a mouse and a keyboard saws the jaw through in a small window, and reads the score.
#include "tests/tools/view/eyes.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdlib>
#include <future>

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

TEST_CASE("a trainee with a mouse saws the jaw through at 800 by 600 and reads the score", "[display][live]") {
    if (!std::getenv("TACTUS_PERSON")) return skip("takes 60 s of a quiet machine; TACTUS_PERSON=1 runs it");
    NEEDS_PERSON(person, display)
    const Folder folder;
    folder.write("script", watching_script("size 800 600\n", 240.0));
    auto done = std::async(std::launch::async, [&] {
        return on(display, folder,
                  "run saw-task --view --layout train --view-script script --set hand.device=mouse --audio none --out "
                  "out --json",
                  300);
    });
    REQUIRE(person.sees_window("Saw task", 30.0));
    const Eyes eyes{folder.path};
    REQUIRE(sees([&] { return eyes.spots().contains("trigger (T)"); }));
    Person::wait(3.0);
    keep(person, "saw-1-begin");
    const Spot scene = eyes.spot("scene picture");
    CHECK(scene.right <= 800.0);
    // From the side of the blade: to the right is into the bone.
    const double y = 0.5 * (scene.top + scene.bottom);
    double x = 0.4 * (scene.left + scene.right);
    person.move(x, y);
    Person::wait(0.3);
    person.tap("3");
    settle(person);
    keep(person, "saw-2-side");
    person.key("t", true);
    person.button(1, true);
    constexpr double behind_the_jaw = 11e-3, pressing_N = 7.0;
    Attempt now;
    bool is_half = false;
    for (int i = 0; i < 700 && !(now.into > behind_the_jaw && !now.touches); ++i) {
        Person::wait(0.15);
        now = attempt_of(eyes);
        // A person waits while the meter is near its limit.
        if (now.force < pressing_N && x < scene.right - 10.0) person.move(x += 1.0, y);
        if (!is_half && now.removed_mm3 > 100.0) {
            is_half = true;
            keep(person, "saw-3-half");
        }
        // A late tick of a busy machine: what the window asks a person to do.
        if (i % 20 == 19 && eyes.spots().contains("Let forces return")) {
            person.button(1, false);
            press(person, eyes, "Let forces return");
            person.move(x, y);
            Person::wait(0.2);
            person.button(1, true);
        }
    }
    person.button(1, false);
    person.key("t", false);
    CHECK(now.into > behind_the_jaw);
    keep(person, "saw-4-through");
    press(person, eyes, "end");
    REQUIRE(sees([&] { return eyes.spots().contains("score"); }));
    settle(person);
    keep(person, "saw-5-score");
    const Spot score = eyes.spot("score"), again = eyes.spot("again");
    CHECK(score.top > again.bottom);
    CHECK(score.bottom < 600.0);
    CHECK(letters_in(person.look(), score) > 1000);
    press(person, eyes, "again");
    REQUIRE(sees([&] { return eyes.spots().contains("end"); }));
    settle(person);
    keep(person, "saw-6-again");
    interrupt(folder.path);
    done.wait();
    const Outcome scored = on(display, folder, "score out --json");
    INFO(scored.out << scored.err);
    REQUIRE(scored.code == 0);
    const json said = json::parse(scored.out);
    // Said only of a bone that is severed in the plane of the cut.
    CHECK(said["breakthrough"]["depth_mm"].is_number());
    CHECK(said["under_mm3"].get<double>() < 5.0);
    CHECK(said["spared"][0]["injured_mm3"].get<double>() > 0.0);
    CHECK(said["force"]["shown"].get<double>() > 0.0);
}
