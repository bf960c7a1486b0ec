// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

using namespace tactus;
using test::NodeHarness;

TEST_CASE("granted_power grants while it is active and a while longer, and tells how long") {
    NodeHarness node("granted_power", {.period = flicks_per_second / 1000});
    node.set("limit", "0.4 W").set("after", "100 ms");
    node.feed<bool>("active", [](std::int64_t k) { return k >= 50 && k < 150; });
    node.prepare();
    node.run(500);
    const auto power = node.values<double>("power");
    CHECK(power[40] == 0.0);
    CHECK(power[60] == Approx(0.4));
    CHECK(power[240] == Approx(0.4));
    CHECK(power[260] == 0.0);
    const Report report = node.report();
    CHECK(std::get<double>(report.sections.at("granted_power").at("max_W")) == Approx(0.4));
    CHECK(std::get<double>(report.sections.at("granted_power").at("time_s")) == Approx(0.2).epsilon(0.02));
}

TEST_CASE("device_output lets a force that leads the hand pass as far as power is granted") {
    const auto joules = [](double watts) {
        NodeHarness node("device_output", {.period = flicks_per_second / 1000});
        double x = 0.0, v = 0.0, given = 0.0;
        node.device_feed = [&](std::int64_t k, DevicePort& port) {
            // A hand of 0.3 kg that brakes with 20 N s/m.
            const double force = port.wrench.force.x, before = x;
            v += (force - 20.0 * v) / 0.3 * 1e-3;
            x += v * 1e-3;
            given += force * (x - before);
            port.sample = {};
            port.sample.pose.position.x = x;
            port.sample.counter = k;
            port.sample.valid = true;
        };
        node.feed<double>("granted", watts);
        node.feed<Wrench>("wrench", [](std::int64_t k) { return k < 300 ? Wrench{} : Wrench{{8.0, 0.0, 0.0}, {}}; });
        node.prepare();
        node.run(1800);
        return given;
    };
    CHECK(joules(0.0) < 0.02);
    CHECK(joules(0.4) > 0.3);
    CHECK(joules(0.4) < 0.7);
}
