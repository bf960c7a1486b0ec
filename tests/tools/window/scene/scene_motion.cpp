// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/scene_motion.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using namespace tactus::window;
using Next = SceneMotion::Next;

TEST_CASE("what moves is drawn coarsely, what stands still once more with all of it, and then no more") {
    SceneMotion motion;
    CHECK(motion.next(1, true, false, 0.0) == Next::coarse);
    CHECK(motion.next(2, true, false, 0.1) == Next::coarse);
    CHECK(motion.next(2, true, false, 0.2) == Next::nothing);
    CHECK(motion.next(2, true, true, 5.0) == Next::nothing);  // somebody is about to move it
    CHECK(motion.next(2, true, false, 5.0) == Next::fine);
    CHECK(motion.next(2, true, false, 6.0) == Next::nothing);
    CHECK(motion.next(3, true, false, 6.1) == Next::coarse);
    motion.forget();
    CHECK(motion.next(3, true, false, 6.2) == Next::coarse);
}

TEST_CASE("where all is drawn at once anyway, what stands still is drawn once") {
    SceneMotion motion;
    CHECK(motion.next(1, false, false, 0.0) == Next::fine);
    CHECK(motion.next(1, false, false, 9.0) == Next::nothing);
}

TEST_CASE("a scene looks otherwise when anything in it moves, changes, is cut, or is explained or seen otherwise") {
    display::Picture picture;
    picture.meshes.resize(2);
    std::vector<display::DrawnView> views(1);
    display::Legend legend;
    legend.entries.resize(1);
    const std::uint64_t before = looks_of(picture, 1, views, legend);
    CHECK(looks_of(picture, 1, views, legend) == before);
    CHECK(looks_of(picture, 2, views, legend) != before);
    display::Picture moved = picture;
    moved.meshes[1].pose.position.z += 1e-9;
    CHECK(looks_of(moved, 1, views, legend) != before);
    moved = picture;
    moved.clip = display::Plane{};
    CHECK(looks_of(moved, 1, views, legend) != before);
    moved = picture;
    moved.points.resize(1);
    CHECK(looks_of(moved, 1, views, legend) != before);
    display::Legend other = legend;
    other.warnings.push_back("not a valid pose: the head stays");
    CHECK(looks_of(picture, 1, views, other) != before);
    other = legend;
    other.entries[0].colour.x = 1.0;
    CHECK(looks_of(picture, 1, views, other) != before);
    views[0].projection.to_eye[3].x = 0.1;
    CHECK(looks_of(picture, 1, views, legend) != before);
}

TEST_CASE(
    "what has too many triangles while it moves is drawn more coarsely until it has not, and finely again when it "
    "may") {
    MotionGrain grain;
    CHECK(grain.pixels() == display::grain_of_motion);
    // Each level of detail has a third of the triangles of the one before.
    const auto drawn = [&](double cells) { return static_cast<std::size_t>(1.5e7 / (cells * cells)); };
    for (int i = 0; i < 20; ++i) grain.drew(drawn(grain.pixels()));
    CHECK(drawn(grain.pixels()) <= 100'000);
    CHECK(drawn(grain.pixels()) > 30'000);
    const double settled = grain.pixels();
    grain.drew(drawn(settled));
    CHECK(grain.pixels() == settled);
    CHECK(grain.samples() == 1);
    for (int i = 0; i < 20; ++i) grain.drew(9'000);
    CHECK(grain.pixels() == display::grain_of_motion);
    CHECK(grain.samples() == 4);
    for (int i = 0; i < 50; ++i) grain.drew(10'000'000);
    CHECK(grain.pixels() <= 20.0);
}
