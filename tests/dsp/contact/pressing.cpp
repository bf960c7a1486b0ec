// SPDX-License-Identifier: Apache-2.0
// What a hand would feel: pressing on things and sliding over them.
#include "dsp/contact/pointshell_contact.hpp"
#include "tests/dsp/contact/bodies.hpp"
#include "tests/support/catch.hpp"

#include <numbers>

using namespace tactus;

namespace {

constexpr double h = 0.35e-3;

double degrees(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / std::numbers::pi;
}

}  // namespace

TEST_CASE("sliding on a ball of 70 voxels and on a plane, direction is true to 0.5° and magnitude to 1 %") {
    const double radius = 70.0 * h, finger = 9.0 * h;
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(1000, finger));
    const contact::Voxmap ball = bodies::ball(176, h, radius);
    const Vec3 up = glm::normalize(Vec3(0.2, -0.3, 1.0));
    const contact::Voxmap plane =
        contact::sample_voxmap(contact::centred_layout(96, h), [&](const Vec3& p) { return glm::dot(p, up); });
    contact::PointshellContact contact(shell.nodes.size());
    for (const contact::Interpolation interpolation :
         {contact::Interpolation::trilinear, contact::Interpolation::quadratic}) {
        const contact::ContactLaw law{.interpolation = interpolation};
        const contact::DepthLaw<double> exact_law(law);
        double worst_angle = 0.0, worst_share = 0.0;
        for (int step = 0; step < 400; ++step) {
            const bool on_ball = step % 2 == 0;
            const double a = 0.004 * step;
            const Vec3 side = glm::normalize(glm::cross(up, Vec3(1, 0, 0)));
            const Vec3 way = on_ball ? Vec3(std::cos(a) * 0.8, std::sin(a), 0.6 * std::cos(2.0 * a)) : up;
            const Vec3 out = glm::normalize(way);
            const double pressed = 1.2 * h;
            const Vec3 centre =
                on_ball ? (radius + finger - pressed) * out : (finger - pressed) * out + side * ((a - 0.8) * 10.0 * h);
            const Pose pose{centre, glm::angleAxis(3.0 * a, glm::normalize(Vec3(1, 2, 3)))};
            const contact::ContactPair pair{&shell, pose, on_ball ? &ball : &plane, {}, true};
            const Vec3 force = contact({&pair, 1}, pose.position, law).wrench().force;
            Vec3 expected(0.0);
            for (const Vec3& p : shell.position) {
                const Vec3 x = pose.apply(p);
                const double distance = on_ball ? glm::length(x) - radius : glm::dot(x, up);
                expected += law.stiffness * exact_law(-distance).force * (on_ball ? glm::normalize(x) : up);
            }
            worst_angle = std::max(worst_angle, degrees(force, expected));
            worst_share = std::max(worst_share, std::abs(glm::length(force) / glm::length(expected) - 1.0));
        }
        CHECK(worst_angle < 0.5);
        CHECK(worst_share < 0.01);
    }
}

TEST_CASE("a wall of thickness t withstands k·(t/2 − h) on one point, wherever it stands in the grid of spacing h") {
    const contact::Pointshell tip =
        contact::make_pointshell(std::vector<contact::SurfacePoint>{{Vec3(0.0), Vec3(0, 0, -1), 1e-6}});
    contact::PointshellContact contact(tip.nodes.size());
    for (const double thickness : {2e-3, 1e-3, 0.7e-3, 0.35e-3}) {
        for (const double offset : {0.0, 0.25, 0.5, 0.8}) {
            const double fine = 0.1e-3;
            const contact::Voxmap wall = contact::sample_voxmap(contact::centred_layout(50, fine), [&](const Vec3& p) {
                return std::abs(p.z - offset * fine) - 0.5 * thickness;
            });
            const contact::ContactLaw law{.stiffness = 1e4, .blend = 0.01e-3};
            double most = 0.0;
            for (int step = 0; step < 400; ++step) {
                const double z = 2e-3 - step * 1e-5;
                const contact::ContactPair pair{&tip, {Vec3(0.0, 0.0, z), Quat(1, 0, 0, 0)}, &wall, {}, true};
                most = std::max(most, contact({&pair, 1}, Vec3(0.0), law).wrench().force.z);
            }
            INFO(thickness << " m, offset " << offset);
            CHECK(most >= 0.999 * law.stiffness * (0.5 * thickness - fine));
            CHECK(most <= 1.001 * law.stiffness * 0.5 * thickness);
        }
    }
}

TEST_CASE("the force is continuous through the surface, at the blend and where it saturates") {
    const contact::Pointshell shell = contact::make_pointshell(bodies::foot_points(8, 4e-3));
    const contact::Voxmap floor =
        contact::sample_voxmap(contact::centred_layout(40, 1e-3), [](const Vec3& p) { return p.z; });
    contact::PointshellContact contact(shell.nodes.size());
    const contact::ContactLaw law{.stiffness = 1e4, .saturation = 0.5e-3};
    double last = 0.0;
    for (int step = 0; step < 2000; ++step) {
        const Pose pose{Vec3(0.0, 0.0, 0.1e-3 - step * 1e-6), Quat(1, 0, 0, 0)};
        const contact::ContactPair pair{&shell, pose, &floor, {}, true};
        const double force = contact({&pair, 1}, pose.position, law).wrench().force.z;
        CHECK(force - last <= 64.0 * 1e4 * 1e-6 * 1.001);
        CHECK(force - last >= -1e-4);
        last = force;
    }
    CHECK(last == Approx(64.0 * 1e4 * 0.5e-3));
}
