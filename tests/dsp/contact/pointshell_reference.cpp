// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/pointshell_contact.hpp"
#include "tests/dsp/contact/bodies.hpp"
#include "tests/support/catch.hpp"

#include <limits>

using namespace tactus;

namespace {

using Six = std::array<double, 6>;

double size_of(const Six& v) {
    double sum = 0.0;
    for (const double x : v) sum += x * x;
    return std::sqrt(sum);
}

/// Central difference of the energy along direction `a` of ξ.
double slope_along(std::span<const contact::ContactPair> pairs, const Vec3& about, const contact::ContactLaw& law,
                   int a, double h) {
    double energy[2];
    for (int side = 0; side < 2; ++side) {
        std::vector<contact::ContactPair> shifted(pairs.begin(), pairs.end());
        Vec3 v(0.0), w(0.0);
        (a < 3 ? v : w)[a % 3] = side ? h : -h;
        for (contact::ContactPair& pair : shifted) {
            Pose& pose = pair.shell_moves ? pair.shell_pose : pair.map_pose;
            pose = bodies::moved(pose, about, v, w);
        }
        energy[side] = contact::contact_reference(shifted, about, law).energy;
    }
    return (energy[1] - energy[0]) / (2.0 * h);
}

}  // namespace

TEST_CASE("gradient is the derivative of the energy to 1e-6, at a thousand poses, whichever body moves") {
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(60, 0.006));
    const contact::Voxmap rough = bodies::rough_ball(48, 1e-3, 0.012);
    const Random random{1};
    int tried = 0;
    for (std::uint64_t n = 0; tried < 1000; ++n) {
        const Pose map_pose = bodies::random_pose(random, 2 * n, 0.05);
        Pose shell_pose = bodies::random_pose(random, 2 * n + 1, 1.0);
        shell_pose.position = map_pose.position + 0.015 * glm::normalize(shell_pose.position);
        const bool smooth = n % 2, by_map = n % 3 == 0;
        const contact::ContactLaw law{
            .stiffness = by_map ? 2e10 : 1e4,
            .blend = 0.1e-3,
            .saturation = n % 5 ? 1e6 : 1.5e-3,
            .by_area = by_map,
            .interpolation = smooth ? contact::Interpolation::quadratic : contact::Interpolation::trilinear};
        const contact::ContactPair pair{&shell, shell_pose, &rough, map_pose, !by_map};
        const Vec3 about = shell_pose.position + Vec3(0.004, -0.002, 0.001);
        // Points must not cross cell faces, where a trilinear field has kinks, within the steps.
        bool apart = true;
        const Pose into = map_pose.inverse() * shell_pose;
        for (const Vec3& p : shell.position) {
            const Vec3 at = (into.apply(p) - rough.grid.origin) / rough.grid.spacing + (smooth ? 0.5 : 0.0);
            const Vec3 to_face = glm::abs(at - glm::round(at));
            apart = apart && std::min({to_face.x, to_face.y, to_face.z}) > 2e-4;
        }
        const contact::ContactSum sum = contact::contact_reference({&pair, 1}, about, law);
        if (!apart || sum.in_contact < 4) continue;
        ++tried;
        double error = 0.0;
        for (int a = 0; a < 6; ++a) {
            const double scale = a < 3 ? 1.0 : 0.01;
            const double h = 1e-7 / scale;
            error = std::max(
                error, std::abs(slope_along({&pair, 1}, about, law, a, h) - sum.gradient[static_cast<std::size_t>(a)]) /
                           scale);
        }
        CHECK(error < 1e-6 * sum.total_force);
    }
}

TEST_CASE("stiffness is symmetric and never negative, and on a plane the derivative of the gradient") {
    const contact::Pointshell shell = contact::make_pointshell(bodies::foot_points(12, 0.01));
    const contact::Voxmap floor =
        contact::sample_voxmap(contact::centred_layout(40, 1e-3), [](const Vec3& p) { return p.z; });
    const contact::Voxmap rough = bodies::rough_ball(48, 1e-3, 0.012);
    const Random random{2};
    for (std::uint64_t n = 0; n < 200; ++n) {
        Pose pose = bodies::random_pose(random, n, 0.012);
        const contact::ContactPair pair{&shell, pose, &rough, {}, n % 2 == 0};
        const contact::ContactLaw law{.direction = n % 3 ? contact::ForceDirection::field_gradient
                                                         : contact::ForceDirection::shell_normal};
        const contact::ContactSum sum = contact::contact_reference({&pair, 1}, pose.position, law);
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j) CHECK(sum.stiffness[6 * i + j] == sum.stiffness[6 * j + i]);
        CHECK(bodies::never_negative(sum.stiffness, 1e-9));
    }
    // Flat on a plane nothing is left out of translation and of the tilt about in-plane axes but the levers' own turn,
    // which is in proportion to the depth.
    const Pose pose{Vec3(0.0013, 0.0004, -0.4e-3), Quat(1, 0, 0, 0)};
    const contact::ContactPair pair{&shell, pose, &floor, {}, true};
    const contact::ContactLaw law;
    const contact::ContactSum sum = contact::contact_reference({&pair, 1}, pose.position, law);
    CHECK(sum.in_contact == 144);
    for (int a = 0; a < 6; ++a) {
        const double h = 1e-7;
        Six g[2];
        for (int side = 0; side < 2; ++side) {
            Vec3 v(0.0), w(0.0);
            (a < 3 ? v : w)[a % 3] = side ? h : -h;
            const contact::ContactPair shifted{&shell, bodies::moved(pose, pose.position, v, w), &floor, {}, true};
            // ω turns about the reference point, which has moved along with v.
            g[side] = contact::contact_reference({&shifted, 1}, pose.position + v, law).gradient;
        }
        for (std::size_t b = 0; b < 6; ++b)
            CHECK(sum.stiffness[6 * b + static_cast<std::size_t>(a)] ==
                  Approx((g[1][b] - g[0][b]) / (2.0 * h)).margin(a < 3 ? 10.0 : 1.0));
    }
}

TEST_CASE("the wrench on one body about a point is opposite to that on the other") {
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(500, 0.006));
    const contact::Voxmap rough = bodies::rough_ball(48, 1e-3, 0.012);
    const Pose pose{Vec3(0.01, 0.012, 0.004), glm::angleAxis(0.4, glm::normalize(Vec3(1, 2, 3)))};
    const Vec3 about(0.003, 0.001, -0.02);
    const contact::ContactPair a{&shell, pose, &rough, {}, true}, b{&shell, pose, &rough, {}, false};
    const Wrench on_shell = contact::contact_reference({&a, 1}, about, {}).wrench();
    const Wrench on_map = contact::contact_reference({&b, 1}, about, {}).wrench();
    CHECK(glm::length(on_shell.force) > 1.0);
    CHECK(on_shell.force == -on_map.force);
    CHECK(on_shell.torque == -on_map.torque);
    // The shell is pushed away from the ball.
    CHECK(glm::dot(on_shell.force, pose.position) > 0.0);
}

TEST_CASE("both bodies moved together feel the same in their own frame") {
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(500, 0.006));
    const contact::Voxmap rough = bodies::rough_ball(48, 1e-3, 0.012);
    const Pose pose{Vec3(0.01, 0.012, 0.004), glm::angleAxis(0.4, glm::normalize(Vec3(1, 2, 3)))};
    const Pose scene{Vec3(1.0, -2.0, 3.0), glm::angleAxis(2.1, glm::normalize(Vec3(-1, 1, 0.3)))};
    const contact::ContactPair still{&shell, pose, &rough, {}, true}, placed{&shell, scene * pose, &rough, scene, true};
    const contact::ContactSum a = contact::contact_reference({&still, 1}, pose.position, {});
    const contact::ContactSum b = contact::contact_reference({&placed, 1}, scene.apply(pose.position), {});
    CHECK(a.energy == Approx(b.energy).epsilon(1e-9));
    CHECK(glm::length(scene.rotate(a.wrench().force) - b.wrench().force) < 1e-8);
    CHECK(glm::length(scene.rotate(a.wrench().torque) - b.wrench().torque) < 1e-9);
}

TEST_CASE("one point feels its law: nothing outside the blend, k·s beyond it, at most k·saturation") {
    const contact::Pointshell shell =
        contact::make_pointshell(std::vector<contact::SurfacePoint>{{Vec3(0.0), Vec3(0, 0, -1), 2e-6}});
    const contact::Voxmap floor =
        contact::sample_voxmap(contact::centred_layout(40, 1e-3), [](const Vec3& p) { return p.z; });
    const auto force = [&](double depth, const contact::ContactLaw& law) {
        const contact::ContactPair pair{&shell, {Vec3(0.0, 0.0, -depth), Quat(1, 0, 0, 0)}, &floor, {}, true};
        return contact::contact_reference({&pair, 1}, Vec3(0.0), law).wrench().force.z;
    };
    const contact::ContactLaw law{.stiffness = 1e4, .blend = 0.03e-3, .saturation = 1e-3};
    CHECK(force(-0.0301e-3, law) == 0.0);
    CHECK(force(0.0, law) == Approx(1e4 * 0.25 * 0.03e-3));
    CHECK(force(0.2e-3, law) == Approx(2.0));
    CHECK(force(0.5e-3, law) == Approx(5.0));
    CHECK(force(1.0e-3, law) == Approx(10.0 * 0.875));
    CHECK(force(1.5e-3, law) == Approx(10.0));
    CHECK(force(9e-3, law) == Approx(10.0));
    // By area: 2 mm² at 5e9 N/m³ is 1e4 N/m.
    CHECK(force(0.2e-3, {.stiffness = 5e9, .by_area = true}) == Approx(2.0));
    CHECK(force(0.2e-3, {.direction = contact::ForceDirection::shell_normal}) == Approx(2.0));
}

TEST_CASE("what is no scene feels nothing") {
    const contact::Pointshell shell = contact::make_pointshell(contact::spread_over_ball(50, 0.006)), none;
    const contact::Voxmap ball = bodies::ball(30, 1e-3, 0.012);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const contact::ContactPair empty{&none, {}, &ball, {}, true}, no_map{&shell, {}, nullptr, {}, true};
    const contact::ContactPair no_pose{&shell, {Vec3(nan, 0, 0), Quat(1, 0, 0, 0)}, &ball, {}, true};
    const contact::ContactPair no_turn{&shell, {Vec3(0.0), Quat(0, 0, 0, 0)}, &ball, {}, true};
    const contact::ContactPair away{&shell, {Vec3(1.0, 0, 0), Quat(1, 0, 0, 0)}, &ball, {}, true};
    for (const contact::ContactPair& pair : {empty, no_map, no_pose, no_turn, away, contact::ContactPair{}}) {
        const contact::ContactSum sum = contact::contact_reference({&pair, 1}, Vec3(0.0), {});
        CHECK(sum.energy == 0.0);
        CHECK(sum.in_contact == 0);
        CHECK(size_of(sum.gradient) == 0.0);
    }
    const contact::ContactPair touching{&shell, {Vec3(0.012, 0, 0), Quat(1, 0, 0, 0)}, &ball, {}, true};
    CHECK(contact::contact_reference({&touching, 1}, Vec3(nan, 0, 0), {}).in_contact == 0);
    CHECK(contact::contact_reference({&touching, 1}, Vec3(0.0), {}).in_contact > 0);
    // At the border of the grid points are either in it or feel nothing: no extrapolation.
    const contact::ContactPair border{&shell, {Vec3(0.0145, 0.0145, 0.0145), Quat(1, 0, 0, 0)}, &ball, {}, true};
    CHECK(std::isfinite(contact::contact_reference({&border, 1}, Vec3(0.0), {}).energy));
}
