// SPDX-License-Identifier: Apache-2.0
// The stiffness sheet against the physics it promises: a mass with damping pressed against a sampled wall.
#include "graph/analyse/stiffness.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/played_device.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace tactus;
using namespace tactus::test;

namespace {

/// A handle of 0.1 kg on a device of damping b, pressed down by 3 N. The force is held between ticks, as by a motor.
struct Handle {
    double mass = 0.1, damping = 2.0, press = 3.0;
    double z = 1e-3, v = 0.0;

    DeviceSample after(std::int64_t count, double elapsed, double force) {
        // The force is constant meanwhile, so the movement is known in closed form.
        const double limit = (force - press) / damping, decay = std::exp(-damping / mass * elapsed);
        z += limit * elapsed + (v - limit) * mass / damping * (1.0 - decay);
        v = limit + (v - limit) * decay;
        DeviceSample sample;
        sample.pose.position.z = z;
        sample.twist.linear.z = v;
        sample.counter = count;
        sample.valid = true;
        return sample;
    }
};

/// The wall is the top of a ball of 1 m radius around a point 1 m below.
std::string pressed_on_a_wall(double newton_per_millimetre, int delay, bool capped = false) {
    return PatchText{
        {{"hand", "device_input", "1 kHz", {{"device", "handle"}}},
         {"wall",
          "sphere_contact",
          "1 kHz",
          {{"centre", "0 m, 0 m, -1 m"},
           {"radius", "1 m"},
           {"tool_radius", "0 mm"},
           {"stiffness", fmt::format("{} N/mm", newton_per_millimetre)}}},
         {"out",
          "device_output",
          "1 kHz",
          {{"device", "handle"},
           {"max_force", "50 N"},
           {"slew", "100 N/ms"},
           {"energy_cap", capped ? "true" : "false"}}}},
        {"hand.pose -> wall.pose",
         delay == 0 ? "wall.wrench -> out.wrench" : fmt::format("wall.wrench -> out.wrench as delay {}", delay)},
        "[devices.handle]\ndriver = \"handle\"\n"}
        .toml();
}

/// What is left of the movement after 12 s, peak velocity in m/s.
double restlessness(double damping, double newton_per_millimetre, int delay, bool capped = false) {
    Handle handle{.damping = damping};
    double worst = 0.0;
    Performance performance;
    performance.info.damping = damping;
    performance.info.max_force = 50.0;
    performance.acquire = [&](std::int64_t count, double elapsed, const Wrench& force) {
        if (count > 11000) worst = std::max(worst, std::abs(handle.v));
        return handle.after(count, elapsed, force.force.z);
    };
    play_as("handle", performance);
    run::EngineOptions options;
    options.seconds = 12.0;
    run::Engine engine(compile_text(pressed_on_a_wall(newton_per_millimetre, delay, capped)), options);
    engine.render(1);
    return worst;
}

}  // namespace

TEST_CASE("a wall below the limit of the sheet comes to rest, one above it hums") {
    for (const double damping : {1.0, 2.0, 5.0})
        for (const int delay : {0, 1, 2}) {
            const compile::Schedule plan = compile_text(pressed_on_a_wall(1.0, delay));
            const auto loops = analyse::force_loops(
                plan, [&](const std::string&) { return DeviceInfo{.name = {}, .damping = damping}; });
            REQUIRE(loops.size() == 1);
            const double limit = loops[0].limit * 1e-3;
            CAPTURE(damping, delay, limit);
            CHECK(limit == Approx(damping / (0.5 + delay)));
            CHECK(restlessness(damping, 0.7 * limit, delay) < 1e-4);
            CHECK(restlessness(damping, 1.3 * limit, delay) > 1e-2);
            // The energy cap leaves such a hand in peace.
            CHECK(restlessness(damping, 0.7 * limit, delay, true) < 1e-3);
        }
}
