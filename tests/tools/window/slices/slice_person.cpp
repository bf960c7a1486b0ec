// SPDX-License-Identifier: Apache-2.0
// A person with a mouse looks at the slices of a plan.
#include "assets/volume/write_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/window/plan/front_view.hpp"
#include "tests/tools/window/walk.hpp"
#include "tools/window/files/window_memory.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using namespace tactus::test;

namespace {

Vec3 middle(const Spot& spot) { return {0.5 * (spot.left + spot.right), 0.5 * (spot.top + spot.bottom), 0.0}; }

/// Pixels of a part of the window with about this colour.
int count(const Person& person, const Spot& part, const Vec3& colour, int within) {
    const Picture seen = person.look();
    int found = 0;
    for (int y = static_cast<int>(part.top); y < std::min(static_cast<int>(part.bottom), seen.height); ++y)
        for (int x = static_cast<int>(part.left); x < std::min(static_cast<int>(part.right), seen.width); ++x) {
            const std::size_t at = 3 * static_cast<std::size_t>(y * seen.width + x);
            bool is_like = true;
            for (int c = 0; c < 3; ++c)
                is_like = is_like && std::abs(seen.rgb[at + static_cast<std::size_t>(c)] - 255.0 * colour[c]) <= within;
            found += is_like ? 1 : 0;
        }
    return found;
}

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a planner's click in a slice of a CT moves the cursor of the scene, and a click on bone that of the slices",
          "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "slices");
        if (!walk.is_possible()) return;
        // A block of bright bone about the first fragment, in air.
        const plan::CasePlan plan = plan::load_case_plan(case_folder() / "case.plan.json");
        const Vec3 at = truth().at(plan.fragments[0].name).middle;
        volume::Grid ct{{60, 60, 60}, at - Vec3(0.03), Vec3(0.001), {}};
        ct.values.assign(ct.count(), -1000.0f);
        for (int k = 20; k < 40; ++k)
            for (int j = 20; j < 40; ++j)
                for (int i = 20; i < 40; ++i) ct.at(i, j, k) = 1500.0f;
        volume::write_volume(ct, volume::WrittenType::int16, walk.folder.path / "ct.nrrd");
        walk.start(
            "run planning-trauma --view --layout plan --scan ct.nrrd --set hand.device=mouse --audio none --out out "
            "--seconds 120 --json",
            120.0);
        REQUIRE(walk.waits_for("part fragment_01"));
        REQUIRE(walk.waits_for("cursor axial"));
        walk.person.tap("1");
        Person::wait(1.5);
        walk.keep("begin");

        // A place of the axial slice: the other slices and the scene go there.
        const Spot axial = walk.eyes.spot("slice axial");
        const Vec3 scene_before = middle(walk.eyes.spot("scene cursor"));
        const Vec3 to = middle(axial) + Vec3(0.2, -0.15, 0.0) * (axial.bottom - axial.top);
        walk.person.click(to.x, to.y);
        CHECK(sees([&] { return glm::length(middle(walk.eyes.spot("cursor axial")) - to) < 4.0; }));
        CHECK(sees([&] { return glm::length(middle(walk.eyes.spot("scene cursor")) - scene_before) > 10.0; }));
        const Spot coronal = walk.eyes.spot("slice coronal");
        CHECK(middle(walk.eyes.spot("cursor coronal")).x - middle(coronal).x ==
              Approx(to.x - middle(axial).x).margin(4.0));

        // The first fragment in the scene: the slices go to its surface, within the block.
        walk.press("part fragment_01", "panel tree");
        const Spot scene = walk.eyes.spot("scene picture");
        const Vec3 fragment_colour = plan.fragments[0].colour;
        const Vec3 pixel = place_in(scene, front_view((scene.right - scene.left) / (scene.bottom - scene.top)), at);
        walk.person.click(pixel.x, pixel.y);
        // What was clicked is where the cursor is drawn, and the block is there in the slice.
        CHECK(sees([&] { return glm::length(middle(walk.eyes.spot("scene cursor")) - pixel) < 4.0; }));
        CHECK(sees([&] {
            const Vec3 cursor = middle(walk.eyes.spot("cursor axial"));
            return count(walk.person, {cursor.x - 12.0, cursor.y - 12.0, cursor.x + 12.0, cursor.y + 12.0}, Vec3(1.0),
                         8) > 60;
        }));
        walk.keep("on-bone");
        CHECK(count(walk.person, walk.eyes.spot("slice axial"), fragment_colour, 25) > 20);

        // The wheel goes to the next slice, out of the block after 30 of them.
        const Vec3 over = middle(walk.eyes.spot("slice axial"));
        walk.person.move(over.x, over.y);
        for (int n = 0; n < 30; ++n) {
            walk.person.button(4, true);
            walk.person.button(4, false);
            Person::wait(0.03);
        }
        CHECK(sees([&] { return count(walk.person, walk.eyes.spot("slice axial"), Vec3(1.0), 8) < 100; }));
        walk.press("Hide slices");
        CHECK(walk.waits_while("slice axial"));
        CHECK(walk.waits_while("scene cursor"));
        walk.keep("hidden");
        walk.stop();
    }
}

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a scan that is given for one case is not shown beside another one, nor remembered for it", "[display]") {
    Walk walk(small_window, "other-case");
    if (!walk.is_possible()) return;
    const volume::Grid ct{{20, 20, 20}, Vec3(-0.01), Vec3(0.001), std::vector<float>(8000, 500.0f)};
    volume::write_volume(ct, volume::WrittenType::int16, walk.folder.path / "ct.nrrd");
    const auto mine = case_folder() / "case.plan.json", other = library_folder() / "cases/fibula-flap/case.plan.json";
    walk.start_script(
        "run planning-trauma --view --layout plan --scan ct.nrrd --set hand.device=mouse --audio none "
        "--out out --seconds 60 --json",
        "until 0.2\nwait 1\nopen " + other.string() + "\nlayout plan\nrun\nwait 2\nuntil 0.2\nwait 1\nclose\n", 60.0);
    walk.end(60.0);
    const window::WindowMemory memory(walk.folder.path / "state/tactus/window.json");
    CHECK(memory.scan_of(mine).filename() == "ct.nrrd");
    CHECK(memory.scan_of(other).empty());
}
