// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/device_model.hpp"

#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;

namespace {

constexpr simulate::HandDynamics alone{
    .mass = 0.1, .inertia = 1e-4, .stiffness = 0.0, .damping = 0.0, .angular_stiffness = 0.0, .angular_damping = 0.0};
const auto nobody = [](double, const Wrench&, const Pose& hand) { return simulate::Intention{hand, {}}; };

}  // namespace

TEST_CASE("a modelled device reports whole encoder steps and a velocity without their noise") {
    for (const simulate::DeviceModel& model : simulate::device_models()) {
        simulate::DeviceModel smooth = model;
        smooth.friction = smooth.viscous = 0.0;
        simulate::ModelledDevice device(smooth, alone);
        device.place({});
        device.launch({{0.05, 0.0, 0.0}, {}});
        double worst = 0.0, worst_difference = 0.0, last = 0.0;
        for (int n = 0; n < 500; ++n) {
            device.advance(nobody, {}, 1e-3);
            const double x = device.pose().position.x, steps = x / model.resolution;
            CHECK(steps == Approx(std::round(steps)).margin(1e-6));
            CHECK(std::abs(x - device.truth().pose.position.x) <= 0.5001 * model.resolution);
            if (n > 50) {
                worst = std::max(worst, std::abs(device.twist().linear.x - 0.05));
                worst_difference = std::max(worst_difference, std::abs((x - last) / 1e-3 - 0.05));
            }
            last = x;
        }
        INFO(model.name);
        CHECK(worst <= 0.2 * worst_difference + 1e-9);
    }
}

TEST_CASE("a modelled device gives its force late, in steps, and no more than it can") {
    for (const simulate::DeviceModel& model : simulate::device_models()) {
        simulate::ModelledDevice device(model, alone);
        device.place({});
        const Wrench wanted{{0.0, 1.0005, 0.0}, {}};
        double begins = 0.0;
        for (int n = 0; n < 40; ++n) {
            device.advance(nobody, wanted, 0.25e-3);
            if (begins == 0.0 && device.acting().force.y > 0.0) begins = 0.25e-3 * (n + 1);
        }
        INFO(model.name);
        CHECK(begins == Approx(model.delay));
        CHECK(device.acting().force.y == Approx(1.0005).margin(0.5 * model.force_step));
        const double steps = device.acting().force.y / model.force_step;
        CHECK(steps == Approx(std::round(steps)).margin(1e-6));
        for (int n = 0; n < 40; ++n) device.advance(nobody, {{0.0, 100.0, 0.0}, {}}, 0.25e-3);
        CHECK(device.acting().force.y == Approx(model.max_force).margin(model.force_step));
    }
}

TEST_CASE("friction of a modelled device holds a hand that is pushed by less, and stops one that flies") {
    const simulate::DeviceModel& touch = *simulate::find_device_model("touch");
    simulate::ModelledDevice device(touch, alone);
    device.place({});
    for (int n = 0; n < 1000; ++n) device.advance(nobody, {{0.9 * touch.friction, 0.0, 0.0}, {}}, 1e-3);
    CHECK(device.truth().pose.position.x == 0.0);
    device.launch({{0.2, 0.0, 0.0}, {}});
    for (int n = 0; n < 1000; ++n) device.advance(nobody, {}, 1e-3);
    CHECK(device.truth().twist.linear.x == 0.0);
    // Half m v² over the friction, a little less by the viscous part.
    const double reach = 0.5 * (0.1 + touch.mass) * 0.04 / touch.friction;
    CHECK(device.truth().pose.position.x == Approx(reach).epsilon(0.05));
}
