// SPDX-License-Identifier: Apache-2.0
// A fragment that the mouse drags: in contact with the others, attracted by a fit, and one step at the end.
#include "tools/window/document/fragment_drag.hpp"

#include "assets/library/fragments.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <cmath>

using namespace tactus;
using window::FragmentDrag;

namespace {

using Parts = std::vector<std::shared_ptr<const nodes::BodyParts>>;

/// The bundled fracture, coarse: the right half lies at +x of the left one, and fits it where both were made.
const Parts& halves() {
    static const Parts made = [] {
        Parts parts;
        for (const bone::Bone& bone :
             library::make_fragments({.voxel = 0.6 * mm, .spacing = 0.8 * mm, .roughness = 0.8 * mm}))
            parts.push_back(nodes::body_of_fragment(bone));
        return parts;
    }();
    return made;
}

/// Until it has arrived, as many pictures would.
void arrive(FragmentDrag& drag) {
    for (int picture = 0; picture < 2000 && !drag.has_arrived(); ++picture) drag.follow(std::chrono::milliseconds(5));
    REQUIRE(drag.has_arrived());
}

double way(const Pose& from, const Pose& to) { return glm::length(to.position - from.position); }

}  // namespace

TEST_CASE("a dragged fragment follows the pointer where nothing is in its way, and no nearer than its bone lets it") {
    FragmentDrag drag(halves(), fit::Arrangement(2), 1);
    drag.move(Vec3(30.0, 4.0, 0.0) * mm);
    arrive(drag);
    CHECK(way(drag.now().pose(1), {Vec3(30.0, 4.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}}) < 0.01 * mm);
    CHECK_FALSE(drag.touches());
    drag.turn(Vec3(0.3, 0.0, 0.0));
    arrive(drag);
    CHECK(std::abs(glm::length(rotation_between(Quat(1.0, 0.0, 0.0, 0.0), drag.now().pose(1).orientation)) - 0.3) <
          1e-3);
    drag.turn(Vec3(-0.3, 0.0, 0.0));
    // Far into the other half: without contact it would end 40 mm inside.
    drag.move(Vec3(-70.0, -4.0, 0.0) * mm);
    arrive(drag);
    CHECK(drag.touches());
    CHECK(drag.now().pose(1).position.x > -1.0 * mm);
    CHECK(drag.now().pose(1).position.x < 3.0 * mm);
    CHECK(drag.now().pose(0).position == Vec3(0.0));
}

TEST_CASE("a dragged fragment slides along the bone that it is pressed against") {
    FragmentDrag drag(halves(), fit::Arrangement(2), 1);
    // Beside the break and above the half, then down onto it and along it.
    drag.move(Vec3(0.0, 40.0, 0.0) * mm);
    arrive(drag);
    drag.move(Vec3(-30.0, 0.0, 0.0) * mm);
    arrive(drag);
    drag.move(Vec3(0.0, -33.0, 0.0) * mm);
    arrive(drag);
    REQUIRE(drag.touches());
    const Pose pressed = drag.now().pose(1);
    drag.move(Vec3(8.0, 0.0, 0.0) * mm);
    arrive(drag);
    CHECK(drag.touches());
    CHECK(drag.now().pose(1).position.x - pressed.position.x > 4.0 * mm);
}

TEST_CASE("a slow machine makes a dragged fragment follow later, and to the same place") {
    FragmentDrag quick(halves(), fit::Arrangement(2), 1), slow(halves(), fit::Arrangement(2), 1);
    for (FragmentDrag* drag : {&quick, &slow}) drag->move(Vec3(20.0, 0.0, 0.0) * mm);
    slow.follow(std::chrono::nanoseconds(0));
    CHECK(way(slow.now().pose(1), Pose{}) < 2.0 * mm);
    CHECK_FALSE(slow.has_arrived());
    arrive(quick);
    for (int n = 0; n < 5000 && !slow.has_arrived(); ++n) slow.follow(std::chrono::nanoseconds(1));
    CHECK(way(slow.now().pose(1), quick.now().pose(1)) < 1e-3 * mm);
}

TEST_CASE("a fit attracts a fragment within reach, holds it against small motions of the pointer and lets it go") {
    FragmentDrag drag(halves(), fit::Arrangement(2), 1);
    drag.attract(Pose{});
    drag.move(Vec3(25.0, 6.0, 0.0) * mm);
    arrive(drag);
    CHECK_FALSE(drag.is_attracted());
    drag.move(Vec3(-22.0, -4.0, 1.0) * mm);
    arrive(drag);
    CHECK(drag.is_attracted());
    CHECK(way(drag.now().pose(1), Pose{}) < 0.2 * mm);
    drag.move(Vec3(2.0, 0.0, 0.0) * mm);
    arrive(drag);
    CHECK(drag.is_attracted());
    drag.move(Vec3(15.0, 0.0, 0.0) * mm);
    arrive(drag);
    CHECK_FALSE(drag.is_attracted());
    CHECK(drag.now().pose(1).position.x > 15.0 * mm);
}

TEST_CASE("a fragment that is only taken stays where it is to the bit, and its group goes with it") {
    Parts parts = halves();
    parts.push_back(parts[1]);
    fit::Arrangement now(3);
    now.place(2, {Vec3(0.0, 0.2, 0.0), rotation_by({0.1, 0.0, 0.0})});
    const int both[] = {1, 2};
    now.join(both);
    FragmentDrag drag(parts, now, 1);
    drag.follow(std::chrono::milliseconds(5));
    CHECK_FALSE(drag.was_moved());
    CHECK(way(drag.now().pose(1), now.pose(1)) == 0.0);
    drag.move(Vec3(10.0, 0.0, 0.0) * mm);
    arrive(drag);
    CHECK(way(drag.now().pose(2), {Vec3(10.0, 200.0, 0.0) * mm, now.pose(2).orientation}) < 0.01 * mm);
}
