// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/loop_stability.hpp"

#include "tests/dsp/control/closed_loop.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using tactus::test::Fate;
using tactus::test::fate;

TEST_CASE("an ideal motor's eigenvalue limit is the closed form within 3 %") {
    for (const int delay : {0, 1, 2, 3, 4})
        for (const double k : {50.0, 200.0, 1000.0, 5000.0})
            for (const double hand : {380.0, 1500.0}) {
                control::LoopModel model{.delay = delay, .motor_lag = 0.0, .hand_stiffness = hand, .stiffness = k};
                CAPTURE(delay, k, hand);
                CHECK(control::gain_limit(model) ==
                      Approx(control::ideal_gain_limit(model.period, delay, hand, k)).epsilon(0.001));
            }
}

TEST_CASE("loops are stable at 0.9 and unstable at 1.1 of the eigenvalue limit") {
    for (const double k : {50.0, 200.0, 1000.0, 5000.0})
        for (const int delay : {0, 1, 2, 3})
            for (const double lag : {0.0, 0.002, 0.004, 0.01})
                for (const double damping : {0.0, 20.0}) {
                    const control::LoopModel model{
                        .delay = delay, .motor_lag = lag, .hand_stiffness = 380.0, .stiffness = k, .damping = damping};
                    const double limit = control::gain_limit(model);
                    CAPTURE(k, delay, lag, damping, limit);
                    REQUIRE(limit > 1.0);
                    CHECK(fate(model, 0.9 * limit) == Fate::dies_down);
                    CHECK(fate(model, 1.1 * limit) == Fate::grows);
                }
}

TEST_CASE("the limit holds for walls, dampers, masses and feed-forward too") {
    std::vector<control::LoopModel> models(6);
    models[0].is_wall = true;
    models[1] = {.stiffness = 0.0, .damping = 20.0};
    models[2] = {.motor_lag = 0.004, .stiffness = 1000.0, .damping = 10.0, .mass = 0.2};
    models[3] = {.motor_lag = 0.004, .feed_forward = 1.0, .feed_forward_lag = 0.02, .stiffness = 1000.0};
    models[4] = {.feed_forward = 1.0, .feed_forward_lag = 0.02, .stiffness = 200.0};
    models[5] = {.delay = 2, .feed_forward = 0.5, .stiffness = 500.0, .damping = 20.0};
    for (std::size_t i = 0; i < models.size(); ++i) {
        models[i].hand_stiffness = 380.0;
        const double limit = control::gain_limit(models[i]);
        CAPTURE(i, limit);
        REQUIRE(limit > 1.0);
        CHECK(fate(models[i], 0.9 * limit) == Fate::dies_down);
        CHECK(fate(models[i], 1.1 * limit) == Fate::grows);
    }
}

TEST_CASE("a soft object lowers the gain, and what is one-sided is as slow as its free side") {
    control::LoopModel model;
    CHECK(control::gain_limit(model, {.stiffness = 50.0}) < 0.3 * control::gain_limit(model, {.stiffness = 5000.0}));
    const control::ObjectSettings two_sided{.kind = control::ObjectKind::wall};
    const control::ObjectSettings barely_damped{
        .kind = control::ObjectKind::wall, .one_sided = true, .free_damping = 0.5};
    CHECK(control::gain_limit(model, two_sided) > 100.0);
    CHECK(control::gain_limit(model, barely_damped) < 0.5 * control::gain_limit(model, two_sided));
}

TEST_CASE("the spectral radius is that of matrices whose eigenvalues are known") {
    control::LoopMatrix m;
    m.size = 2;
    m.at[0] = {0.6, -0.8};
    m.at[1] = {0.8, 0.6};
    CHECK(control::spectral_radius(m) == Approx(1.0).epsilon(1e-6));  // a rotation
    m.at[0] = {0.5, 1000.0};
    m.at[1] = {0.0, 0.5};
    CHECK(control::spectral_radius(m) == Approx(0.5).epsilon(1e-5));  // defective
    m.at[0] = {0.0, 1.0};
    m.at[1] = {0.0, 0.0};
    CHECK(control::spectral_radius(m) == 0.0);
}
