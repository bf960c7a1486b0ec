// SPDX-License-Identifier: Apache-2.0
#include "nodes/contact/made_bodies.hpp"
#include "dsp/contact/shape.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using namespace tactus::nodes;

namespace {

/// A ball of 20 mm whose distance field has samples `voxel` apart.
std::shared_ptr<const BodyParts> make_ball(double voxel) {
    const contact::Ball ball{10e-3};
    return std::make_shared<const BodyParts>(contact::make_pointshell(ball.points(2e-3)),
                                             contact::voxmap_of(ball, voxel, 3e-3), Pose{}, false);
}

}  // namespace

TEST_CASE("a body is made once for equal parameters, and anew for others") {
    MadeBodies bodies;
    int made = 0;
    const auto get = [&](double diameter) {
        return bodies.get(BodyKey{0.0, diameter}, [&] {
            ++made;
            return make_ball(2e-3);
        });
    };
    const auto first = get(1.0);
    CHECK(get(1.0) == first);
    CHECK(made == 1);
    CHECK(get(2.0) != first);
    CHECK(made == 2);
    CHECK(get(1.0) == first);
    CHECK(made == 2);
}

TEST_CASE("bodies beyond the bound are dropped, the oldest first, and live on where they are used") {
    MadeBodies bodies;
    int made = 0;
    const auto get = [&](double number) {
        return bodies.get(BodyKey{number}, [&] {
            ++made;
            return make_ball(0.15e-3);  // 5.3 million samples, 21 MB
        });
    };
    const auto first = get(1.0);
    const std::uint64_t hash = first->content_hash;
    for (double n = 2.0; n < 6.0; ++n) get(n);
    CHECK(made == 5);
    get(5.0);
    CHECK(made == 5);
    get(1.0);
    CHECK(made == 6);
    CHECK(first->content_hash == hash);
}

TEST_CASE("a body that could not be made is not kept") {
    MadeBodies bodies;
    const auto fail = []() -> std::shared_ptr<const BodyParts> { throw Error("no"); };
    CHECK_THROWS_AS(bodies.get(BodyKey{}, fail), Error);
    CHECK(bodies.get(BodyKey{}, [] { return make_ball(2e-3); }) != nullptr);
}
