// SPDX-License-Identifier: Apache-2.0
// A mass thrown at a patch: device, contact, limiter, energy cap and the engine's commit as one loop.
#include "tests/engine/chaos.hpp"
#include "tests/engine/played_device.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

using namespace tactus;
using namespace tactus::test;

namespace {

/// A handle without friction that flies down at the top of a ball of 1 m radius, 100 ms after the start.
struct Thrown {
    double mass = 0.3, speed = 0.2, quantum = 20e-6;
    double z = 3e-3, v = 0.0, fastest_out = 0.0;

    DeviceSample after(std::int64_t count, double elapsed, double force) {
        if (count == 400) v = -speed;
        z += v * elapsed + 0.5 * force / mass * elapsed * elapsed;
        v += force / mass * elapsed;
        fastest_out = std::max(fastest_out, v);
        DeviceSample sample;
        sample.pose.position.z = std::round(z / quantum) * quantum;
        sample.counter = count;
        sample.valid = true;
        return sample;
    }
};

std::string wall(double newton_per_millimetre, bool capped) {
    return PatchText{
        {{"hand", "device_input", "1 kHz", {{"device", "handle"}}},
         {"wall",
          "sphere_contact",
          "1 kHz",
          {{"centre", "0 m, 0 m, -1 m"},
           {"radius", "1 m"},
           {"tool_radius", "0 mm"},
           {"stiffness", fmt::format("{} N/mm", newton_per_millimetre)}}},
         {"out", "device_output", "1 kHz", {{"device", "handle"}, {"energy_cap", capped ? "true" : "false"}}}},
        {"hand.pose -> wall.pose", "wall.wrench -> out.wrench"},
        "[devices.handle]\ndriver = \"handle\"\n"}
        .toml();
}

/// Kinetic energy after the bounce over that before.
double returned(double mass, double newton_per_millimetre, bool capped) {
    Thrown thrown{.mass = mass};
    Performance performance;
    performance.acquire = [&](std::int64_t count, double elapsed, const Wrench& force) {
        return thrown.after(count, elapsed, force.force.z);
    };
    play_as("handle", performance);
    run::EngineOptions options;
    options.seconds = 0.8;
    run::Engine engine(compile_text(wall(newton_per_millimetre, capped)), options);
    engine.render(1);
    return thrown.fastest_out * thrown.fastest_out / (thrown.speed * thrown.speed);
}

}  // namespace

TEST_CASE("a patch returns at most 1.05 of the energy of a bounce, and several times as much without its energy cap") {
    CHECK(returned(0.3, 12.8, true) <= 1.05);
    CHECK(returned(0.3, 12.8, false) > 3.0);
    CHECK(returned(0.1, 5.0, true) <= 1.05);
    CHECK(returned(0.1, 5.0, false) > 1.2);
    // A soft wall that needs no cap still throws the hand back.
    CHECK(returned(0.3, 1.0, true) > 0.9);
}
