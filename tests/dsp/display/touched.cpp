// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/touched.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/coupling/placement.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tactus;

namespace {

/// Touches in a cube of 200 mm with normal noise of `sigma` on each axis.
struct Toucher {
    Random random{11};
    std::uint64_t draw = 0;
    double sigma = 0.5e-3;

    Vec3 place() {
        Vec3 v;
        for (int axis = 0; axis < 3; ++axis) v[axis] = 0.2 * (random.uniform(draw++) - 0.5);
        return v;
    }
    Vec3 noise() {
        Vec3 v;
        for (int axis = 0; axis < 3; ++axis) {
            double sum = -6.0;
            for (int n = 0; n < 12; ++n) sum += random.uniform(draw++);
            v[axis] = sigma * sum;
        }
        return v;
    }
};

const Pose placed{{0.3, -0.1, 0.7}, coupling::rotation_xyz({0.4, -1.1, 2.0})};

}  // namespace

TEST_CASE("dsp: a workspace calibrated by noisy touches is right within 1 mm all over a 200 mm cube") {
    Toucher toucher;
    double worst = 0.0, worst_affine = 0.0;
    for (int study = 0; study < 50; ++study) {
        std::vector<display::TouchPair> touches;
        for (int n = 0; n < 20; ++n) {
            const Vec3 at = toucher.place();
            touches.push_back({at, placed.apply(at) + toucher.noise()});
        }
        const display::RigidFit rigid = display::fit_rigid(touches);
        const display::AffineFit affine = display::fit_affine(touches);
        CHECK(rigid.residual.rms == Approx(0.5e-3 * std::sqrt(3.0)).epsilon(0.4));
        CHECK(rigid.residual.worst >= rigid.residual.rms);
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 at = 0.1 * Vec3((corner & 1) * 2 - 1, (corner & 2) - 1, (corner >> 2) * 2 - 1);
            worst = std::max(worst, glm::length(rigid.pose.apply(at) - placed.apply(at)));
            worst_affine = std::max(worst_affine, glm::length(affine.apply(at) - placed.apply(at)));
        }
    }
    CHECK(worst < 1e-3);
    CHECK(worst_affine < 2e-3);  // four times as many unknowns
}

TEST_CASE("dsp: exact touches give the exact map, also one that stretches, and say so by a residual of nothing") {
    Toucher toucher;
    const Mat3 stretch(Vec3(1.05, 0.0, 0.01), Vec3(0.02, 0.97, 0.0), Vec3(0.0, 0.0, 1.1));
    std::vector<display::TouchPair> rigid, affine;
    for (int n = 0; n < 8; ++n) {
        const Vec3 at = toucher.place();
        rigid.push_back({at, placed.apply(at)});
        affine.push_back({at, stretch * at + Vec3(0.1, 0.2, 0.3)});
    }
    const display::RigidFit r = display::fit_rigid(rigid);
    CHECK(glm::length(r.pose.position - placed.position) < 1e-12);
    CHECK(r.residual.worst < 1e-12);
    const display::AffineFit a = display::fit_affine(affine);
    CHECK(a.residual.worst < 1e-12);
    CHECK(glm::length(a.linear[2] - stretch[2]) < 1e-12);
    // The rigid fit of a stretched workspace shows the stretch, and names the touch that is farthest off.
    affine[5].to += Vec3(0.0, 0.03, 0.0);
    CHECK(display::fit_rigid(affine).residual.rms > 2e-3);
    CHECK(display::fit_rigid(affine).residual.worst_touch == 5);
}

TEST_CASE("dsp: the corners of a screen and the plane of a mirror come out of noisy touches within 1 mm") {
    Toucher toucher;
    const display::Screen true_screen{placed.apply({-0.1, 0.0, -0.06}), placed.apply({0.1, 0.0, -0.06}),
                                      placed.apply({-0.1, 0.0, 0.06})};
    double worst = 0.0, worst_mirror = 0.0;
    for (int study = 0; study < 50; ++study) {
        std::vector<display::ScreenTouch> marks;
        std::vector<Vec3> mirror;
        for (int n = 0; n < 16; ++n) {
            const glm::dvec2 shown(0.05 + 0.3 * (n % 4), 0.05 + 0.3 * (n / 4));
            marks.push_back({shown, true_screen.low_left + true_screen.right() * shown.x + true_screen.up() * shown.y +
                                        toucher.noise()});
            Vec3 at = toucher.place();
            at.y = 0.0;
            mirror.push_back(placed.apply(at) + toucher.noise());
        }
        const display::ScreenFit screen = display::fit_screen(marks);
        CHECK(glm::dot(screen.screen.right(), screen.screen.up()) == Approx(0.0).margin(1e-12));
        CHECK(std::abs(screen.skew_rad) < 0.02);
        worst = std::max({worst, glm::length(screen.screen.low_left - true_screen.low_left),
                          glm::length(screen.screen.low_right - true_screen.low_right),
                          glm::length(screen.screen.high_left - true_screen.high_left)});
        const display::PlaneFit plane = display::fit_plane(mirror, placed.apply({0.0, 1.0, 0.0}));
        CHECK(plane.residual.rms < 1e-3);
        for (const double x : {-0.1, 0.1})
            for (const double z : {-0.1, 0.1})
                worst_mirror = std::max(worst_mirror, std::abs(plane.plane.height(placed.apply({x, 0.0, z}))));
        CHECK(plane.plane.height(placed.apply({0.0, 1.0, 0.0})) == Approx(1.0).epsilon(0.01));
    }
    CHECK(worst < 1e-3);
    CHECK(worst_mirror < 1e-3);
}

TEST_CASE("dsp: touches that decide nothing are refused by what is missing") {
    const auto line = [](double x) { return display::TouchPair{{x, 2.0 * x, 0.0}, {x, 0.0, 2.0 * x}}; };
    std::vector<display::TouchPair> touches{line(0.0), line(0.1)};
    CHECK_THROWS_WITH(display::fit_rigid(touches), Catch::Matchers::ContainsSubstring("at least 3"));
    touches.push_back(line(0.2));
    CHECK_THROWS_WITH(display::fit_rigid(touches), Catch::Matchers::ContainsSubstring("on a line"));
    touches.push_back({{0.1, 0.0, 0.0}, {0.1, 0.05, 0.0}});
    CHECK_THROWS_WITH(display::fit_affine(touches), Catch::Matchers::ContainsSubstring("in a plane"));
    touches[0].to.x = std::nan("");
    CHECK_THROWS_WITH(display::fit_rigid(touches), Catch::Matchers::ContainsSubstring("touch 1"));
    CHECK_THROWS_WITH(display::fit_rigid(std::vector<display::TouchPair>(5)),
                      Catch::Matchers::ContainsSubstring("at one place"));
    CHECK_THROWS_WITH(display::fit_plane(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}),
                      Catch::Matchers::ContainsSubstring("do not lie in a plane"));
    const std::vector<display::ScreenTouch> mixed{{{0, 0}, {0, 0, 0}}, {{1, 0}, {0.5, 0, 0}}, {{0, 1}, {0.2, 0.3, 0}}};
    CHECK_THROWS_WITH(display::fit_screen(mixed), Catch::Matchers::ContainsSubstring("skewed"));
}
