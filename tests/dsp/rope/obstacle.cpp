// SPDX-License-Identifier: Apache-2.0
// A point that goes no farther than the free way of its place must not meet the bone: ropes do not look there.
#include "dsp/rope/obstacle.hpp"

#include "dsp/contact/voxmap.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/rope/bone_field.hpp"
#include "dsp/rope/rope.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace tactus;
using namespace tactus::rope;

namespace {

/// A bone of three balls; its field ends close around it, so that the distance jumps there.
contact::Voxmap tight_field() {
    volume::Grid grid;
    grid.size = {40, 32, 30};
    grid.spacing = Vec3(0.5 * mm, 0.6 * mm, 0.7 * mm);
    grid.origin = -0.5 * Vec3(39, 31, 29) * grid.spacing;
    return contact::sample_voxmap(grid, [](const Vec3& p) {
        const double one = glm::length(p - Vec3(3.0, 0.0, 0.0) * mm) - 5.0 * mm;
        const double two = glm::length(p + Vec3(3.0, 2.0, 0.0) * mm) - 4.0 * mm;
        return std::min({one, two, glm::length(p + Vec3(0.0, 0.0, 4.0) * mm) - 5.0 * mm});
    });
}

struct Ways {
    double nearest = std::numeric_limits<double>::infinity();  // m, beyond what is near
    int free = 0;
};

/// Goes at random within the free way of random places.
Ways go(const Obstacle& bone, double near) {
    const Random random{17};
    Ways ways;
    std::uint64_t drawn = 0;
    for (int n = 0; n < 4000; ++n) {
        const auto place_in = [&](double size) {
            const double x = random.uniform(drawn), y = random.uniform(drawn + 1), z = random.uniform(drawn + 2);
            drawn += 3;
            return size * (2.0 * Vec3(x, y, z) - 1.0);
        };
        const Vec3 place = place_in(20.0 * mm);
        Vec3 normal;
        const double now = bone.distance(place, normal), way = bone.free_way(place, now, near);
        if (!(way > 0.0)) continue;
        ++ways.free;
        for (int k = 0; k < 30; ++k) {
            Vec3 out = place_in(1.0);
            out *= way / std::max(glm::length(out), 1e-9) * (k % 3 == 0 ? 0.5 : 0.999);
            ways.nearest = std::min(ways.nearest, bone.distance(place + out, normal) - near);
        }
    }
    return ways;
}

}  // namespace

TEST_CASE("within the free way of a place nothing comes near a ball or a cylinder") {
    for (const double near : {0.0, 1.5 * mm}) {
        const Ways ball = go(Ball(Vec3(0.0), 6.0 * mm), near);
        const Ways drum = go(Cylinder(Vec3(0.0), Vec3(0.0, 1.0, 0.0), 6.0 * mm), near);
        CHECK(ball.nearest > 0.0);
        CHECK(drum.nearest > 0.0);
        CHECK(ball.free > 1000);
        CHECK(drum.free > 1000);
    }
}

TEST_CASE("within the free way of a place nothing comes near a bone, also where its field ends") {
    const contact::Voxmap field = tight_field();
    const Pose pose{Vec3(2.0, -1.0, 3.0) * mm, glm::angleAxis(0.7, glm::normalize(Vec3(1.0, 2.0, 3.0)))};
    const BoneField bone(field, pose);
    for (const double near : {0.0, 1.0 * mm, 1.5 * mm}) {
        CAPTURE(near);
        const Ways ways = go(bone, near);
        CHECK(ways.nearest > 0.0);
        CHECK(ways.free > 1000);
    }
}

TEST_CASE("a rope whose bone is gone passes where it was") {
    const Ball bone(Vec3(0.0, 0.0, -10.0 * mm), 10.0 * mm);
    std::vector<Vec3> line;
    for (int n = 0; n <= 32; ++n) line.emplace_back((2.0 * n - 32.0) * mm, 0.0, 2.0 * mm);
    Rope rope(line, std::vector<double>(32, 2.0 * mm), artery());
    const auto pull_to = [&](double z, const Obstacle* against) {
        rope.hold(0, line.front() + Vec3(-2.0 * mm, 0.0, z));
        rope.hold(32, line.back() + Vec3(2.0 * mm, 0.0, z));
        RopeStep seen;
        int unsolved = 0, iterations = 0;
        for (int n = 0; n < 100; ++n) {
            seen = rope.step(1e-3, against);
            unsolved += !seen.is_solved;
            iterations += seen.iterations;
        }
        CAPTURE(iterations);
        CHECK(unsolved == 0);
        return seen.contacts;
    };
    CHECK(pull_to(-8.0 * mm, &bone) > 0);
    CHECK(pull_to(-12.0 * mm, nullptr) == 0);
    CHECK(rope.points()[16].z == Approx(-10.0 * mm).margin(0.5 * mm));
}
