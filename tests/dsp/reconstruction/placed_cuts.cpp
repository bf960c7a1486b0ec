// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/placed_cuts.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <vector>

using namespace tactus;
using namespace tactus::reconstruction;

namespace {

/// A jaw of three segments with tilted end cuts; the donor's line is not through its origin.
FibulaInputs three_segments(bool reversed) {
    FibulaInputs inputs;
    inputs.planes = {{Vec3(-40.0, 10.0, 3.0) * mm, Vec3(0.9, -0.4, 0.1), {}},
                     {Vec3(-20.0, -20.0, 0.0) * mm, {}, Vec3(0.1, 0.2, 1.0)},
                     {Vec3(15.0, -25.0, 4.0) * mm, {}, {}},
                     {Vec3(38.0, 5.0, 2.0) * mm, Vec3(0.6, 0.9, 0.0), {}}};
    inputs.line_point = Vec3(100.0, 50.0, -200.0) * mm;
    inputs.line_direction = Vec3(0.1, -0.05, 1.0);
    inputs.reversed = reversed;
    inputs.roll = 0.4;
    inputs.along_line = reversed ? std::vector<double>{170.0 * mm, 110.0 * mm, 60.0 * mm}
                                 : std::vector<double>{60.0 * mm, 110.0 * mm, 170.0 * mm};
    return inputs;
}

std::vector<Pose> poses_of(const FibulaPlan& plan) {
    std::vector<Pose> poses;
    for (const FibulaSegment& s : plan.segments) poses.push_back(s.donor_to_target);
    return poses;
}

}  // namespace

TEST_CASE("pieces that lie where they are planned give the cuts of the plan back") {
    for (const bool reversed : {false, true}) {
        CAPTURE(reversed);
        const FibulaInputs inputs = three_segments(reversed);
        const FibulaPlan plan = plan_fibula(inputs);
        const PlacedCuts cuts = cuts_of_placed(inputs, plan, poses_of(plan));
        CHECK_FALSE(cuts.is_spaced_anew);
        for (std::size_t n = 0; n < plan.segments.size(); ++n) {
            CHECK(cuts.moved[n] < 1e-9);
            CHECK(cuts.turned[n] < 1e-9);
            for (std::size_t end = 0; end < 2; ++end) {
                const Plane &before = plan.segments[n].donor_plane[end], &now = cuts.plan.segments[n].donor_plane[end];
                CHECK(glm::length(before.origin - now.origin) < 1e-9);
                CHECK(glm::dot(before.normal, now.normal) == Approx(1.0).margin(1e-12));
            }
        }
    }
}

TEST_CASE("a joint lies where the axes of two placed pieces meet, and its plane bisects their angle") {
    const FibulaInputs inputs = three_segments(false);
    const FibulaPlan plan = plan_fibula(inputs);
    std::vector<Pose> placed = poses_of(plan);
    // The middle piece is shifted in the plane of its two neighbours' axes, so that all axes still meet.
    const auto axis = [&](const Pose& pose) { return pose.rotate(glm::normalize(inputs.line_direction)); };
    const Vec3 shift = 2.0 * mm * axis(placed[0]);
    placed[1].position += shift;
    const PlacedCuts cuts = cuts_of_placed(inputs, plan, placed);
    CHECK(cuts.moved[1] < 0.9 * mm);  // only the joint to the third piece cannot keep both axes
    CHECK(glm::length(cuts.inputs.planes[1].origin - inputs.planes[1].origin - shift) < 1e-9);
    CHECK(cuts.plan.off_bisector[0] < 1e-9);
    CHECK(cuts.plan.off_bisector[1] < 1e-9);
    CHECK(cuts.plan.segments[0].length_centre == Approx(plan.segments[0].length_centre + 2.0 * mm).margin(1e-9));
}

TEST_CASE("a piece that was rolled about its axis keeps its roll, and no axis moves") {
    const FibulaInputs inputs = three_segments(true);
    const FibulaPlan plan = plan_fibula(inputs);
    std::vector<Pose> placed = poses_of(plan);
    const Vec3 about = placed[1].rotate(glm::normalize(inputs.line_direction)), on = placed[1].apply(inputs.line_point);
    const Quat roll = glm::angleAxis(0.5, about);
    placed[1] = {on + roll * (placed[1].position - on), roll * placed[1].orientation};
    const PlacedCuts cuts = cuts_of_placed(inputs, plan, placed);
    for (std::size_t n = 0; n < 3; ++n) {
        CHECK(cuts.moved[n] < 1e-9);
        CHECK(cuts.turned[n] < 1e-9);
    }
    CHECK(glm::length(rotation_between(plan.segments[1].donor_to_target.orientation,
                                       cuts.plan.segments[1].donor_to_target.orientation)) == Approx(0.5).margin(1e-9));
}

TEST_CASE("pieces of overlapping parts of the donor are cut elsewhere, with the wanted space") {
    FibulaInputs inputs = three_segments(false);
    const FibulaPlan plan = plan_fibula(inputs);
    std::vector<Pose> placed = poses_of(plan);
    placed[1].position -= 30.0 * mm * placed[1].rotate(glm::normalize(inputs.line_direction));
    const PlacedCuts cuts = cuts_of_placed(inputs, plan, placed);
    CHECK(cuts.is_spaced_anew);
    CHECK(cuts.inputs.along_line.empty());
    for (std::size_t n = 0; n + 1 < 3; ++n)
        CHECK(cuts.plan.segments[n + 1].along_line[0] ==
              Approx(cuts.plan.segments[n].along_line[1] + inputs.between).margin(1e-9));
}
