// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"
#include "assets/library/mandible.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace tactus;
using test::NodeHarness;

namespace {

DeviceSample sample_at(double x, std::int64_t counter) {
    DeviceSample sample;
    sample.pose.position.x = x;
    sample.twist.linear.x = 0.1;
    sample.buttons = button_trigger;
    sample.counter = counter;
    sample.valid = true;
    return sample;
}

double number_of(const Report& report, const std::string& section, const std::string& key) {
    return std::get<double>(report.sections.at(section).at(key));
}

}  // namespace

TEST_CASE("device_input holds the last good pose, and lets go of the trigger, while samples are bad") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    NodeHarness node("device_input", test::servo);
    node.device_feed = [&](std::int64_t k, DevicePort& port) {
        port.sample = sample_at(0.001 * static_cast<double>(k), k);
        if (k == 5) port.sample.valid = false;
        if (k == 6) port.sample.pose.position.y = nan;
        if (k == 7) port.sample.pose.orientation = {0.0, 0.0, 0.0, 0.0};
    };
    node.prepare();
    node.run(10);
    const auto poses = node.values<Pose>("pose");
    for (const std::size_t k : {5u, 6u, 7u}) {
        CHECK(poses[k].position == poses[4].position);
        CHECK_FALSE(node.values<bool>("valid")[k]);
        CHECK_FALSE(node.values<bool>("trigger")[k]);
        CHECK(node.values<Twist>("twist")[k].linear.x == 0.0);
    }
    CHECK(poses[8].position.x == Approx(0.008));
    CHECK(node.values<bool>("trigger")[8]);
}

TEST_CASE("a sample that freezes the pose at device_input is a fault at device_output, whichever number is bad") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, infinite, -infinite})
        for (int number = 0; number < 13; ++number) {
            CAPTURE(bad, number);
            const auto feed = [&](std::int64_t k, DevicePort& port) {
                port.sample = sample_at(0.0, k);
                if (k < 500) return;
                DeviceSample& s = port.sample;
                double* const numbers[13] = {&s.pose.position.x,    &s.pose.position.y,    &s.pose.position.z,
                                             &s.pose.orientation.w, &s.pose.orientation.x, &s.pose.orientation.y,
                                             &s.pose.orientation.z, &s.twist.linear.x,     &s.twist.linear.y,
                                             &s.twist.linear.z,     &s.twist.angular.x,    &s.twist.angular.y,
                                             &s.twist.angular.z};
                *numbers[number] = bad;
            };
            NodeHarness input("device_input", test::servo), output("device_output", test::servo);
            input.device_feed = output.device_feed = feed;
            output.feed<Wrench>("wrench",
                                [](std::int64_t k) { return k < 300 ? Wrench{} : Wrench{{2.0, 0.0, 0.0}, {}}; });
            input.prepare();
            output.prepare();
            input.run(511);
            output.run(511);
            CHECK_FALSE(input.last<bool>("valid"));
            CHECK(output.values<Wrench>("applied")[499].force.x == Approx(2.0));
            CHECK(output.last<Wrench>("applied").force.x == 0.0);
            CHECK(output.host.devices.at("")->fault == control::Fault::invalid_input);
        }
}

TEST_CASE("a value that is overdue fades the force within 10 ms, and it comes back as after a late tick") {
    for (const control::Fault fault :
         {control::Fault::late_value, control::Fault::old_world, control::Fault::unusable_value}) {
        NodeHarness node("device_output", test::servo);
        node.device_feed = [&](std::int64_t k, DevicePort& port) {
            port.sample = sample_at(0.0, k);
            port.overdue = k >= 500 && k < 700 ? fault : control::Fault::none;
        };
        node.feed<Wrench>("wrench", [](std::int64_t k) { return k < 300 ? Wrench{} : Wrench{{2.0, 0.0, 0.0}, {}}; });
        node.prepare();
        node.run(600);
        CHECK(node.values<Wrench>("applied")[499].force.x == Approx(2.0));
        CHECK(node.values<Wrench>("applied")[509].force.x == 0.0);
        CHECK(node.host.devices.at("")->fault == fault);
        node.run(2000);
        const auto applied = node.values<Wrench>("applied");
        for (std::size_t k = 510; k < 1690; ++k) REQUIRE(applied[k].force.x == 0.0);
        CHECK(node.last<Wrench>("applied").force.x == Approx(2.0));
    }
}

TEST_CASE("device_output bounds what reaches the hand and tells what it was asked for") {
    NodeHarness node("device_output", test::servo);
    node.set("max_force", "6 N");
    node.device_feed = [](std::int64_t k, DevicePort& port) { port.sample = sample_at(0.0, k); };
    node.feed<Wrench>("wrench",
                      [](std::int64_t k) { return k < 300 ? Wrench{} : Wrench{{k < 600 ? 2.0 : 40.0, 0.0, 0.0}, {}}; });
    node.prepare();
    node.run(1000);
    const auto applied = node.values<Wrench>("applied");
    CHECK(applied[550].force.x == Approx(2.0));
    CHECK(applied[999].force.x == Approx(6.0));
    for (std::size_t k = 1; k < applied.size(); ++k)
        REQUIRE(std::abs(applied[k].force.x - applied[k - 1].force.x) <= 1.0 + 1e-12);
    CHECK(node.host.devices.at("")->wrench.force.x == applied.back().force.x);
    CHECK(node.host.driven);
    const Report report = node.report();
    CHECK(number_of(report, "force", "max_N") == Approx(6.0));
    CHECK(number_of(report, "force", "raw_max_N") == Approx(40.0));
    CHECK(number_of(report, "force", "raw_max_step_N") == Approx(38.0));
    CHECK(number_of(report, "force", "over_limit_ticks") == 400.0);
}

TEST_CASE("the report of two hands has the larger force, the sum of counts and the fault of either") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    const auto report_of = [&](double force, bool fails, Report before) {
        NodeHarness node("device_output", test::servo);
        node.set("energy_cap", fails ? "true" : "false");
        node.device_feed = [](std::int64_t k, DevicePort& port) { port.sample = sample_at(0.0, k); };
        node.feed<Wrench>("wrench", [=](std::int64_t k) {
            return k < 300 ? Wrench{} : Wrench{{fails && k >= 900 ? nan : force, 0.0, 0.0}, {}};
        });
        node.prepare();
        node.run(1000);
        return node.report(std::move(before));
    };
    for (const bool first_fails : {true, false}) {
        const Report one = report_of(first_fails ? 4.0 : 1.0, first_fails, {});
        const Report both = report_of(first_fails ? 1.0 : 4.0, !first_fails, one);
        CHECK(number_of(both, "force", "max_N") == Approx(4.0));
        CHECK(number_of(both, "force", "faults") == 1.0);
        CHECK(number_of(both, "force", "ticks") == 2000.0);
        const Report alone = report_of(first_fails ? 1.0 : 4.0, !first_fails, {});
        CHECK(number_of(both, "force", "mean_N") ==
              Approx(0.5 * (number_of(one, "force", "mean_N") + number_of(alone, "force", "mean_N"))));
        const auto text = [&](const char* key) { return std::get<std::string>(both.sections.at("force").at(key)); };
        CHECK(text("fault") == control::describe(control::Fault::not_finite));
        CHECK(text("energy_cap") == "off");
    }
}

TEST_CASE("device_output takes the device's own limit when that is lower") {
    NodeHarness node("device_output", test::servo);
    node.host.device("", DeviceUse::read, {}).info.max_force = 3.0;
    node.device_feed = [](std::int64_t k, DevicePort& port) { port.sample = sample_at(0.0, k); };
    node.feed<Wrench>("wrench", [](std::int64_t k) { return k < 300 ? Wrench{} : Wrench{{8.0, 0.0, 0.0}, {}}; });
    node.prepare();
    node.run(600);
    CHECK(node.last<Wrench>("applied").force.x == Approx(3.0));
}

TEST_CASE("device_output lets go, and says why, when the device stops delivering samples") {
    NodeHarness node("device_output", test::servo);
    node.device_feed = [](std::int64_t k, DevicePort& port) {
        port.sample = sample_at(0.0, std::min<std::int64_t>(k, 500));
    };
    node.feed<Wrench>("wrench", [](std::int64_t k) { return k < 300 ? Wrench{} : Wrench{{5.0, 0.0, 0.0}, {}}; });
    node.prepare();
    node.run(600);
    CHECK(node.values<Wrench>("applied")[490].force.x == Approx(5.0));
    CHECK(node.last<Wrench>("applied").force.x == 0.0);
    CHECK(std::get<std::string>(node.report().sections.at("force").at("fault")).find("stopped") != std::string::npos);
}

TEST_CASE("forces return to a device that gives fewer samples than there are ticks, after its samples were bad") {
    for (const std::int64_t ticks : {1, 2, 5, 9}) {
        CAPTURE(ticks);
        NodeHarness node("device_output", test::servo);
        node.device_feed = [&](std::int64_t k, DevicePort& port) {
            port.sample = sample_at(0.0, k / ticks);
            if (k >= 500 && k < 520) port.sample.valid = false;
        };
        node.feed<Wrench>("wrench", [](std::int64_t k) {
            return k < 300 || (k > 1000 && k < 1700) ? Wrench{} : Wrench{{2.0, 0.0, 0.0}, {}};
        });
        node.prepare();
        node.run(2000);
        CHECK(node.values<Wrench>("applied")[490].force.x == Approx(2.0));
        CHECK(node.values<Wrench>("applied")[900].force.x == 0.0);
        CHECK(node.last<Wrench>("applied").force.x == Approx(2.0));
    }
    // One whose samples do not come back stays without.
    NodeHarness node("device_output", test::servo);
    node.device_feed = [](std::int64_t k, DevicePort& port) {
        port.sample = sample_at(0.0, std::min<std::int64_t>(k, 500));
    };
    node.feed<Wrench>("wrench", [](std::int64_t k) {
        return k < 300 || k > 2000 ? Wrench{{k < 300 ? 0.0 : 2.0, 0.0, 0.0}, {}} : Wrench{};
    });
    node.prepare();
    node.run(3000);
    CHECK(node.last<Wrench>("applied").force.x == 0.0);
}

TEST_CASE("device_output tells what the hand felt, and since when forces were off while the patch asked for some") {
    NodeHarness node("device_output", test::servo);
    node.set("recover_after", "0 s");
    node.device_feed = [](std::int64_t k, DevicePort& port) {
        port.sample = sample_at(0.0, k);
        if (k >= 600) port.sample.valid = false;
    };
    node.feed<Wrench>("wrench",
                      [](std::int64_t k) { return k < 300 ? Wrench{} : Wrench{{k < 600 ? 2.0 : 8.0, 0.0, 0.0}, {}}; });
    node.prepare();
    node.run(1500);
    const Report report = node.report();
    CHECK(number_of(report, "force", "off_s") == Approx(0.9).margin(0.02));
    CHECK(number_of(report, "force", "off_from_s") == Approx(0.6).margin(0.02));
    CHECK(number_of(report, "force", "off_until_s") == Approx(1.499));
    // 300 ticks of 2 N, 900 of none.
    CHECK(number_of(report, "force", "felt_mean_N") == Approx(0.5).margin(0.05));
}

TEST_CASE("workspace and device_wrench together keep the power of hand and tool equal") {
    const Pose handle{{0.03, 0.01, -0.02}, rotation_by({0.3, 0.7, -0.2})};
    const Vec3 velocity(0.2, -0.1, 0.05);
    const double dt = 1e-3 / 1024.0;
    NodeHarness place("workspace", test::servo);
    place.disconnect("clutch").disconnect("turn");
    place.set("origin", "10 mm, -20 mm, 5 mm").set("rotation", "30 deg, 40 deg, -70 deg").set("scale", "2.5");
    place.set("grip", "0 mm, 30 mm, -80 mm").set("grip_rotation", "-90 deg, 10 deg, 0 deg");
    place.feed<Pose>("device", [&](std::int64_t k) {
        return Pose{handle.position + velocity * (static_cast<double>(k) * dt), handle.orientation};
    });
    place.prepare();
    place.run(2);
    const auto tools = place.values<Pose>("pose");

    const Wrench on_tool{{3.0, -5.0, 2.0}, {0.1, 0.2, -0.3}};
    NodeHarness back("device_wrench", test::servo);
    back.set("scale", "2.5").feed("wrench", on_tool).feed("tool", tools[0]);
    back.feed("frame", place.values<Pose>("frame")[0]);
    back.prepare();
    back.run(1);
    const double scene = glm::dot(on_tool.force, (tools[1].position - tools[0].position) / dt);
    CHECK(glm::dot(back.last<Wrench>("on_hand").force, velocity) == Approx(scene).epsilon(1e-9));
    CHECK(place.last<double>("force_scale") == 2.5);
}

TEST_CASE("a workspace with a bone puts the resting blade in front of it, teeth towards it") {
    NodeHarness node("workspace", test::servo);
    node.disconnect("clutch").disconnect("turn");
    node.asset("bone", test::sample_asset("bone")).set("clearance", "4 mm");
    node.feed<Pose>("device", [](std::int64_t k) {
        return Pose{k == 1   ? Vec3(0.0, 0.0, -3e-3)
                    : k == 2 ? Vec3(2e-3, 0.0, 0.0)
                             : Vec3(0.0),
                    Quat(1.0, 0.0, 0.0, 0.0)};
    });
    node.prepare();
    node.run(3);
    const auto tools = node.values<Pose>("pose");
    const Vec3 inwards = -glm::normalize(tools[0].position);  // the bone is a ball of 10 mm about the origin
    CHECK(glm::length(tools[0].position) == Approx(14e-3).epsilon(0.01));
    CHECK(glm::dot(tools[0].rotate({0.0, 1.0, 0.0}), inwards) > 0.99);
    CHECK(glm::length(tools[1].position) == Approx(11e-3).epsilon(0.01));
    CHECK(glm::length(tools[2].position - tools[0].position - tools[0].rotate({2e-3, 0.0, 0.0})) < 1e-9);
    const Report report = node.report();
    CHECK(std::get<double>(report.sections.at("site").at("thickness_mm")) == Approx(20.0).margin(1.0));
}

TEST_CASE("on the bundled mandible the blade goes across the body from the outside, clear of everything else",
          "[slow]") {
    const auto mandible = std::make_shared<const bone::Bone>(library::make_mandible());
    NodeHarness node("workspace", test::servo);
    node.disconnect("clutch").disconnect("turn");
    node.asset("bone", mandible);
    node.prepare();
    const Report report = node.report();
    const auto& site = report.sections.at("site");
    const auto normal = std::get<std::vector<double>>(site.at("normal"));
    const auto stroke = std::get<std::vector<double>>(site.at("stroke"));
    CHECK(std::hypot(normal[1], normal[2]) > 0.8);  // the arch runs along x here
    CHECK(std::abs(stroke[0]) < 0.4);
    CHECK(std::get<double>(site.at("thickness_mm")) > 8.0);
    CHECK(std::get<double>(site.at("thickness_mm")) < 20.0);
    CHECK(std::get<double>(site.at("width_mm")) < 32.0);
}

TEST_CASE("a workspace says so when a bone has no place for a blade") {
    bone::Bone air = *std::static_pointer_cast<const bone::Bone>(test::sample_asset("bone"));
    for (float& d : air.distance.values) d = 1.0f;
    NodeHarness node("workspace", test::servo);
    node.disconnect("clutch").disconnect("turn");
    node.asset("bone", std::make_shared<const bone::Bone>(air));
    CHECK_THROWS_WITH(node.prepare(), Catch::Matchers::ContainsSubstring("leave 'bone' out"));
}
