// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr double no_time = std::numeric_limits<double>::quiet_NaN();

double time_of(std::int64_t k) { return 1e-3 * static_cast<double>(k); }

}  // namespace

TEST_CASE("the derivative of a parabola is a line, of a steady line with noise the line's slope") {
    NodeHarness exact("differentiate", {.period = ms});
    exact.feed<double>("in", [](std::int64_t k) { return 5.0 * time_of(k) * time_of(k); });
    exact.prepare();
    exact.run(1001);
    // The slope between the last two values is that of the middle between them.
    CHECK(exact.last<double>("out") == Approx(10.0 * (1.0 - 0.5e-3)));
    NodeHarness vector("differentiate", {.period = ms, .any = &value::vector});
    vector.set("noise", "0.002").feed<Vec3>("in", [](std::int64_t k) {
        const double noise = k % 2 == 0 ? 0.4e-3 : -0.4e-3;
        return Vec3(2.0 * time_of(k) + noise, noise, -time_of(k));
    });
    vector.prepare();
    vector.run(500);
    const Vec3 slope = vector.last<Vec3>("out");
    CHECK(std::abs(slope.x - 2.0) < 0.1);
    CHECK(std::abs(slope.y) < 0.1);
    CHECK(std::abs(slope.z + 1.0) < 0.1);
}

TEST_CASE("a value that is not finite is left out of a derivative") {
    NodeHarness node("differentiate", {.period = ms});
    node.feed<double>("in", [](std::int64_t k) { return k == 5 ? no_time : 3.0 * time_of(k); });
    node.prepare();
    node.run(10);
    const auto out = node.values<double>("out");
    for (std::size_t k = 1; k < out.size(); ++k) CHECK(out[k] == Approx(3.0));
}

TEST_CASE("the integral of a cosine is a sine, a leak forgets, the limit holds") {
    NodeHarness node("integrate", {.period = ms});
    const double w = 2.0 * std::numbers::pi;
    node.feed<double>("in", [=](std::int64_t k) { return w * std::cos(w * time_of(k + 1)); }).feed("reset", false);
    node.prepare();
    node.run(250);
    // Trapezia from a first value of 0, half a millisecond before.
    CHECK(node.last<double>("out") == Approx(1.0).margin(5e-3));
    NodeHarness leaky("integrate", {.period = ms});
    leaky.set("leak", "50 ms").feed("in", 2.0).feed("reset", false);
    leaky.prepare();
    leaky.run(1000);
    CHECK(leaky.last<double>("out") == Approx(2.0 * 0.05).epsilon(1e-3));
    NodeHarness limited("integrate", {.period = ms});
    limited.set("limit", "0.25").feed("in", 100.0).feed<bool>("reset", [](std::int64_t k) { return k == 99; });
    limited.prepare();
    limited.run(99);
    CHECK(limited.last<double>("out") == 0.25);
    limited.run(1);
    CHECK(limited.last<double>("out") == 0.0);
}

TEST_CASE("a delay gives the value of so many ticks ago") {
    NodeHarness node("delay", {.period = ms});
    node.set("time", "7 ms").feed<double>("in", [](std::int64_t k) { return 1.0 + static_cast<double>(k); });
    node.prepare();
    node.run(100);
    const auto out = node.values<double>("out");
    for (std::size_t k = 0; k < out.size(); ++k) CHECK(out[k] == (k < 7 ? 0.0 : static_cast<double>(k) - 6.0));
    NodeHarness none("delay", {.period = ms});
    none.set("time", "0 s").feed("in", 4.0);
    none.prepare();
    none.run(1);
    CHECK(none.last<double>("out") == 4.0);
    NodeHarness sound("delay", {.any = &value::signal});
    sound.set("time", "1 ms").feed<float>("in", [](std::int64_t k) { return static_cast<float>(k + 1); });
    sound.prepare();
    sound.run(100);
    CHECK(sound.values<float>("out")[47] == 0.0f);
    CHECK(sound.values<float>("out")[48] == 1.0f);
    CHECK(sound.values<float>("out")[99] == 52.0f);
    NodeHarness pose("delay", {.period = ms, .any = &value::pose});
    pose.feed("in", Pose{{1.0, 2.0, 3.0}, {}});
    pose.prepare();
    pose.run(1);
    CHECK(pose.last<Pose>("out").orientation.w == 1.0);
}

TEST_CASE("slew rises and falls no faster than its limits") {
    NodeHarness node("slew", {.period = ms, .any = &value::wrench});
    node.set("rise", "100 1/s").set("fall", "50 1/s");
    node.feed<Wrench>("in", [](std::int64_t k) { return k < 100 ? Wrench{{5.0, 0.02, 0.0}, {}} : Wrench{}; });
    node.prepare();
    node.run(200);
    const auto out = node.values<Wrench>("out");
    CHECK(out[9].force.x == Approx(1.0));
    CHECK(out[49].force.x == Approx(5.0));
    CHECK(out[99].force.x == Approx(5.0));
    CHECK(out[99].force.y == Approx(0.02));
    CHECK(out[119].force.x == Approx(4.0));
    CHECK(out[199].force.x < 1e-12);
    NodeHarness sound("slew", {.any = &value::signal});
    sound.set("rise", "4800 1/s").feed("in", 1.0f);
    sound.prepare();
    sound.run(20);
    CHECK(sound.values<float>("out")[4] == Approx(0.5f));
    CHECK(sound.values<float>("out")[19] == 1.0f);
}

TEST_CASE("smooth is at 63 % after its time constant, and turns a pose by the shortest way") {
    NodeHarness node("smooth", {.period = ms});
    node.set("time", "100 ms").feed<double>("in", [](std::int64_t k) { return k == 0 ? 0.0 : 1.0; });
    node.prepare();
    node.run(101);
    CHECK(node.last<double>("out") == Approx(1.0 - std::exp(-1.0)));
    const Vec3 turn(0.0, 0.0, 2.0);
    NodeHarness pose("smooth", {.period = ms, .any = &value::pose});
    pose.set("time", "100 ms").feed<Pose>("in", [&](std::int64_t k) {
        return k == 0 ? Pose{} : Pose{{0.1, 0.0, 0.0}, -rotation_by(turn)};
    });
    pose.prepare();
    pose.run(101);
    const double share = 1.0 - std::exp(-1.0);
    CHECK(pose.last<Pose>("out").position.x == Approx(0.1 * share));
    CHECK(glm::length(rotation_between(rotation_by(share * turn), pose.last<Pose>("out").orientation)) < 1e-9);
}

TEST_CASE("attack, decay, sustain and release take the time they say") {
    NodeHarness node("adsr", {.period = ms});
    node.set("attack", "10 ms").set("decay", "100 ms").set("sustain", "0.4").set("release", "50 ms");
    node.feed<bool>("gate", [](std::int64_t k) { return k < 500; });
    node.prepare();
    node.run(1000);
    const auto level = node.values<double>("level");
    CHECK(level[4] == Approx(0.5));
    CHECK(level[9] == Approx(1.0));
    CHECK(level[109] == Approx(0.4 + 0.01 * 0.6).margin(1e-3));
    CHECK(level[499] == Approx(0.4).margin(1e-6));
    CHECK(level[549] == Approx(0.01 * 0.4).epsilon(0.01));
    CHECK(level[999] == 0.0);
    CHECK(*std::ranges::max_element(level) == 1.0);
}

TEST_CASE("a slow oscillator has its shape and keeps its phase") {
    const auto values = [](const char* shape) {
        NodeHarness node("slow_oscillator", {.period = ms});
        node.set("shape", shape).set("frequency", "2 Hz").set("amplitude", "3").set("offset", "1");
        node.prepare();
        node.run(1000);
        return node.values<double>("out");
    };
    const auto sine = values("sine"), triangle = values("triangle"), square = values("square"), ramp = values("ramp");
    for (std::size_t k = 0; k < 1000; ++k) {
        const double phase = std::fmod(2e-3 * static_cast<double>(k), 1.0);
        CHECK(sine[k] == Approx(1.0 + 3.0 * std::sin(2.0 * std::numbers::pi * phase)).margin(1e-9));
        CHECK(triangle[k] ==
              Approx(1.0 + 3.0 * 2.0 / std::numbers::pi * std::asin(std::sin(2.0 * std::numbers::pi * phase)))
                  .margin(1e-6));
        if (std::abs(phase - 0.5) > 1e-6 && phase > 1e-6 && phase < 1.0 - 1e-6) {
            CHECK(square[k] == (phase < 0.5 ? 4.0 : -2.0));
            CHECK(ramp[k] == Approx(1.0 + 3.0 * (2.0 * phase - 1.0)).margin(1e-9));
        }
    }
}

TEST_CASE("random numbers have their mean and spread, and are drawn at the trigger") {
    for (const char* distribution : {"uniform", "normal"}) {
        NodeHarness node("random_number", {.period = ms});
        node.set("distribution", distribution).set("centre", "5").set("spread", "2").disconnect("trigger");
        node.prepare();
        node.run(40'000);
        double sum = 0.0, squares = 0.0;
        for (const double x : node.values<double>("out")) {
            sum += x - 5.0;
            squares += (x - 5.0) * (x - 5.0);
        }
        CHECK(std::abs(sum / 40'000) < 0.04);
        const double deviation = std::sqrt(squares / 40'000);
        CHECK(deviation == Approx(std::string(distribution) == "normal" ? 2.0 : 2.0 / std::sqrt(3.0)).epsilon(0.02));
    }
    NodeHarness node("random_number", {.period = ms});
    node.feed<bool>("trigger", [](std::int64_t k) { return k % 10 == 5; });
    node.prepare();
    node.run(100);
    const auto out = node.values<double>("out");
    int changes = 0;
    for (std::size_t k = 1; k < out.size(); ++k) changes += out[k] != out[k - 1];
    CHECK(changes == 10);
}

TEST_CASE("a leak that is shorter than a tick gives its time constant times the value") {
    for (const char* leak : {"0.1 ms", "1 ms", "20 ms", "5 s"}) {
        NodeHarness node("integrate", {.period = ms});
        node.set("leak", leak).feed("in", 2.0).disconnect_optional();
        node.prepare();
        node.run(60'000);
        const double tau = std::stod(leak) * (std::string(leak).find("ms") == std::string::npos ? 1.0 : 1e-3);
        CHECK(node.last<double>("out") == Approx(2.0 * tau).epsilon(1e-4));
    }
}

TEST_CASE("a leaky integral of a ramp is that of the differential equation") {
    const double tau = 3e-3;
    NodeHarness node("integrate", {.period = ms});
    node.set("leak", "3 ms").disconnect_optional().feed<double>("in", [](std::int64_t k) { return time_of(k + 1); });
    node.prepare();
    node.run(40);
    // y' = t - y / tau from 0.
    const auto out = node.values<double>("out");
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double t = time_of(static_cast<std::int64_t>(k) + 1);
        CHECK(out[k] == Approx(tau * (t - tau * (1.0 - std::exp(-t / tau)))));
    }
}

TEST_CASE("a smoothed signal does not follow samples that are not finite") {
    NodeHarness node("smooth", {.any = &value::signal});
    node.set("time", "1 ms").feed<float>("in", [](std::int64_t k) {
        return k < 480 ? 1.0f : std::numeric_limits<float>::quiet_NaN();
    });
    node.prepare();
    node.run(960);
    CHECK(node.values<float>("out").back() == 1.0f);
}
