// SPDX-License-Identifier: Apache-2.0
// A mass thrown at a patch: device, contact, limiter, energy cap and the engine's commit as one loop.
#include "tests/engine/chaos.hpp"
#include "tests/engine/played_device.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

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

/// Two hands at the ends of a spring of 1 N/mm, each on a device: one is led to and fro by its owner, 20 mm at 0.5 Hz, the
/// other is a mass of 0.3 kg in a grip of 20 N·s/m that follows.
struct TwoHands {
    double leader = 0.0, follower = 0.0, speed = 0.0, t = 0.0;
    double wanted = 0.0, given = 0.0, largest = 0.0, put_in = 0.0;  ///< sums of N; N; J by the leader

    explicit TwoHands(const std::string& coupling, const std::vector<std::string>& grants) {
        Performance lead, follow;
        lead.acquire = [this](std::int64_t count, double elapsed, const Wrench& force) {
            t += elapsed;
            const double before = std::exchange(leader, t < 0.2 ? 0.0 : 20e-3 * std::sin(std::numbers::pi * (t - 0.2)));
            put_in -= force.force.x * (leader - before);
            return sample_at(leader, count);
        };
        follow.acquire = [this](std::int64_t count, double elapsed, const Wrench& force) {
            follower += speed * elapsed;
            speed += (force.force.x - 20.0 * speed) / 0.3 * elapsed;
            wanted += std::abs(1e3 * (leader - follower));
            given += std::abs(force.force.x);
            largest = std::max(largest, std::abs(force.force.x));
            return sample_at(follower, count);
        };
        play_as("lead", lead);
        play_as("follow", follow);
        PatchText patch{{{"a", "device_input", "1 kHz", {{"device", "lead"}}},
                         {"b", "device_input", "1 kHz", {{"device", "follow"}}},
                         {"on_a", "device_output", "1 kHz", {{"device", "lead"}}},
                         {"on_b", "device_output", "1 kHz", {{"device", "follow"}}}},
                        grants,
                        "[devices.lead]\ndriver = \"lead\"\n[devices.follow]\ndriver = \"follow\"\n"};
        if (coupling == "hand_coupling") {
            patch.nodes.push_back({"spring", "hand_coupling", "1 kHz", {}});
            patch.wires.insert(patch.wires.end(), {"a.pose -> spring.a", "b.pose -> spring.b",
                                                   "spring.on_a -> on_a.wrench", "spring.on_b -> on_b.wrench"});
        } else {
            for (const auto& [own, other] : {std::pair{"a", "b"}, std::pair{"b", "a"}}) {
                const std::string spring = std::string("spring_") + own;
                patch.nodes.push_back({spring, "spring", "1 kHz", {{"stiffness", "1 N/mm"}}});
                patch.wires.insert(patch.wires.end(), {std::string(own) + ".pose -> " + spring + ".device",
                                                       std::string(other) + ".pose -> " + spring + ".object",
                                                       spring + ".wrench -> on_" + own + ".wrench"});
            }
        }
        run::EngineOptions options;
        options.seconds = 4.2;
        run::Engine engine(compile_text(patch.toml()), options);
        engine.render(1);
    }

    static DeviceSample sample_at(double x, std::int64_t count) {
        DeviceSample sample;
        sample.pose.position.x = std::round(x / 20e-6) * 20e-6;
        sample.counter = count;
        sample.valid = true;
        return sample;
    }
};

}  // namespace

TEST_CASE("through two devices, a hand that is led feels the spring to the other hand where the patch declares it") {
    const TwoHands coupled("hand_coupling", {"spring.granted_a -> on_a.granted", "spring.granted_b -> on_b.granted"});
    CAPTURE(coupled.given, coupled.wanted, coupled.largest, coupled.put_in);
    CHECK(coupled.given > 0.95 * coupled.wanted);
    CHECK(coupled.largest < 3.0);  // 20 N·s/m at 63 mm/s are 1.3 N
    CHECK(coupled.put_in > 0.1);
    // Two springs that declare nothing: the cap of the hand that is led takes most of it.
    const TwoHands shared("spring", {});
    CAPTURE(shared.given, shared.wanted);
    CHECK(shared.given < 0.5 * shared.wanted);
}

TEST_CASE("a patch returns at most 1.05 of the energy of a bounce, and several times as much without its energy cap") {
    CHECK(returned(0.3, 12.8, true) <= 1.05);
    CHECK(returned(0.3, 12.8, false) > 3.0);
    CHECK(returned(0.1, 5.0, true) <= 1.05);
    CHECK(returned(0.1, 5.0, false) > 1.2);
    // A soft wall that needs no cap still throws the hand back.
    CHECK(returned(0.3, 1.0, true) > 0.9);
}
