// SPDX-License-Identifier: Apache-2.0
// Guides keep their laws and their largest force, and give a hand on a simulated device no more energy than sampling
// explains.
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/simulate/device_model.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using test::NodeHarness;

namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

struct Guide {
    const char* type;
    Settings settings;
};

const std::vector<Guide>& guides() {
    static const std::vector<Guide> all{
        {"point_guide", {{"reach", "10 mm"}}},
        {"point_guide", {}},
        {"line_guide", {{"direction", "1, 1, 0"}}},
        {"line_guide", {{"length", "10 mm"}, {"reach", "5 mm"}}},
        {"plane_guide", {}},
        {"plane_guide", {{"kind", "both"}, {"reach", "6 mm"}}},
        {"box_guide", {{"size", "6 mm, 6 mm, 6 mm"}}},
        {"box_guide", {{"size", "10 mm, 8 mm, 8 mm"}, {"keep", "outside"}}},
        {"path_guide", {{"points", "-10 0 0, 0 5 2, 10 0 0 mm"}}},
        {"path_guide", {{"points", "-10 0 0, 0 5 2, 10 0 0 mm"}, {"shape", "straight"}, {"closed", "true"}}},
        {"detents", {{"spacing", "3 mm"}}},
        {"dial", {{"notches", "24"}}},
    };
    return all;
}

/// The force of a guide on a hand at rest at `p`, or moving.
Wrench felt(const char* type, const Settings& settings, const Pose& pose, const Twist& twist = {},
            const Pose& frame = {}) {
    NodeHarness node(type, test::servo);
    for (const auto& [name, text] : settings) node.set(name, text);
    node.feed("pose", pose).feed("twist", twist).feed("frame", frame);
    node.prepare();
    node.run(1);
    return node.last<Wrench>("wrench");
}
Vec3 force(const char* type, const Settings& settings, const Vec3& p, const Vec3& v = {}) {
    return felt(type, settings, {p, {1.0, 0.0, 0.0, 0.0}}, {v, {}}).force;
}
void check_near(const Vec3& given, const Vec3& wanted) {
    CAPTURE(given.x, given.y, given.z, wanted.x, wanted.y, wanted.z);
    CHECK(glm::distance(given, wanted) < 1e-9 * (1.0 + glm::length(wanted)));
}

/// A hand on a device that draws closed curves through a guide: work of the guide on it, and what sampling explains.
struct Loop {
    double work = 0.0, explained = 0.0, most = 0.0;  // J, J, N or N·m
};

Loop drawn(const Guide& guide, const simulate::DeviceModel& model, bool is_damped, double seconds, int rate = 1000) {
    constexpr double stiffness = 500.0, torsion = 0.5;
    const double dt = 1.0 / rate;
    simulate::ModelledDevice device(model, {});
    const auto intended = [](double t) {
        const double w = 2.0 * pi;
        // Begins and ends at rest in one place.
        const double in = std::min(1.0, t);
        return Pose{
            in * Vec3(8.0 * mm * std::sin(w * t), 5.0 * mm * std::sin(2.0 * w * t), 6.0 * mm * std::sin(3.0 * w * t)),
            rotation_by(in * Vec3(0.1 * std::sin(w * t), 0.1 * std::sin(2.0 * w * t), 0.9 * std::sin(w * t)))};
    };
    NodeHarness node(guide.type, {.period = flicks_per_second / rate});
    for (const auto& [name, text] : guide.settings) node.set(name, text);
    if (!is_damped) node.disconnect("twist");
    node.disconnect("frame");
    node.feed<Pose>("pose", [&](std::int64_t) { return device.pose(); });
    node.feed<Twist>("twist", [&](std::int64_t) { return device.twist(); });
    node.prepare();
    Loop loop;
    double time = 0.0;
    Pose before;
    Wrench acting;
    bool has_begun = false;
    const auto account = [&](const Wrench& felt, const Pose& pose) {
        if (has_begun)
            loop.work += glm::dot(acting.force, pose.position - before.position) +
                         glm::dot(acting.torque, rotation_between(before.orientation, pose.orientation));
        has_begun = true;
        before = pose;
        acting = felt;
    };
    const auto intend = [&](double h, const Wrench& felt, const Pose& pose) {
        account(felt, pose);
        const double t = time + 0.5 * h;
        time += h;
        const Pose a = intended(t - 1e-5), b = intended(t + 1e-5);
        return simulate::Intention{
            intended(t), {(b.position - a.position) / 2e-5, rotation_between(a.orientation, b.orientation) / 2e-5}};
    };
    // The force of a sample is held for a tick, and late by the device's delay.
    const double late = 1.0 + 2.0 * model.delay / dt;
    for (int tick = 0; tick < static_cast<int>(seconds / dt); ++tick) {
        const Pose from = device.truth().pose;
        node.run(1);
        const Wrench command = node.last<Wrench>("wrench");
        node.forget();
        loop.most = std::max({loop.most, glm::length(command.force), glm::length(command.torque)});
        device.advance(intend, command, dt);
        const Vec3 step = device.truth().pose.position - from.position;
        const Vec3 turn = rotation_between(from.orientation, device.truth().pose.orientation);
        loop.explained += 0.5 * late * (stiffness * glm::dot(step, step) + torsion * glm::dot(turn, turn));
        // A sample is within half a step of the truth.
        loop.explained += stiffness * 0.5 * model.resolution * glm::length(step) +
                          torsion * 0.5 * model.angular_resolution * glm::length(turn);
    }
    return loop;
}

std::vector<simulate::DeviceModel> devices() {
    simulate::DeviceModel ideal;
    ideal.name = "ideal";
    ideal.max_force = 20.0;
    ideal.max_torque = 1.0;
    std::vector<simulate::DeviceModel> all{ideal};
    for (const simulate::DeviceModel& model : simulate::device_models()) {
        all.push_back(model);
        // The dial is to act on these too.
        all.back().max_torque = std::max(model.max_torque, 0.2);
    }
    return all;
}

}  // namespace

TEST_CASE("guides pull to their shape by stiffness times distance, and damp what leads away from it") {
    const Settings soft{{"stiffness", "0.2 N/mm"}, {"damping", "3 N s/m"}};
    check_near(force("point_guide", soft, {2.0 * mm, 0.0, 1.0 * mm}, {0.0, 0.1, 0.0}), {-0.4, -0.3, -0.2});
    check_near(force("line_guide", soft, {2.0 * mm, 9.0 * mm, 1.0 * mm}, {0.1, 0.5, 0.0}), {-0.7, 0.0, -0.2});
    check_near(force("plane_guide", soft, {1.0, 1.0, -2.0 * mm}, {0.3, 0.3, 0.05}), {0.0, 0.0, 0.4 - 0.15});
    check_near(force("plane_guide", soft, {1.0, 1.0, 2.0 * mm}), {0.0, 0.0, 0.0});
    check_near(force("box_guide", soft, {52.0 * mm, 0.0, 53.0 * mm}), {-0.4, 0.0, -0.6});
    check_near(
        force("path_guide", {{"points", "0 0 0, 10 0 0, 10 10 0 mm"}, {"shape", "straight"}, {"stiffness", "0.2 N/mm"}},
              {12.0 * mm, 5.0 * mm, 3.0 * mm}),
        {-0.4, 0.0, -0.6});
    Settings kind = soft;
    kind.emplace_back("kind", "both");
    check_near(force("plane_guide", kind, {1.0, 1.0, 2.0 * mm}), {0.0, 0.0, -0.4});
    Settings out = soft;
    out.emplace_back("keep", "outside");
    CHECK(glm::distance(force("box_guide", out, {0.0, -49.0 * mm, 0.0}), {0.0, -0.2, 0.0}) < 1e-5);
}

TEST_CASE("detents and a dial push to their notches by a sine") {
    for (const double x : {-4.3, -1.0, 0.4, 1.6, 8.8})
        check_near(
            force("detents", {{"stiffness", "1 N/mm"}, {"spacing", "4 mm"}, {"first", "1 mm"}}, {x * mm, 1.0, 2.0}),
            {-1e3 * 4.0 * mm / (2.0 * pi) * std::sin(2.0 * pi * (x - 1.0) / 4.0), 0.0, 0.0});
    for (const double degrees : {-170.0, -20.0, 5.0, 33.0, 179.0}) {
        const double angle = degrees * pi / 180.0;
        const Wrench w =
            felt("dial", {{"notches", "18"}, {"stiffness", "0.9 N m/rad"}}, {{}, rotation_by({0.0, 0.0, angle})});
        check_near(w.torque, {0.0, 0.0, -0.9 / 18.0 * std::sin(18.0 * angle)});
    }
    NodeHarness node("dial", test::servo);
    node.disconnect_optional().feed("pose", Pose{{}, rotation_by({0.0, 0.0, -0.6})});
    node.prepare();
    node.run(1);
    CHECK(node.last<double>("notch") == 11.0);
    CHECK(node.last<double>("angle") == Approx(-0.6));
}

TEST_CASE("the frame of a guide moves and turns its law") {
    const Pose frame{{0.1, 0.2, 0.3}, rotation_by({0.3, -0.4, 1.2})};
    for (const Guide& guide : guides()) {
        const Pose hand{{4.0 * mm, -1.0 * mm, 2.0 * mm}, rotation_by({0.0, 0.0, 0.1})};
        const Twist twist{{0.01, 0.02, -0.03}, {0.1, 0.0, 0.4}};
        const Wrench here = felt(guide.type, guide.settings, hand, twist);
        const Wrench there = felt(guide.type, guide.settings, frame * hand,
                                  {frame.orientation * twist.linear, frame.orientation * twist.angular}, frame);
        INFO(guide.type);
        check_near(there.force, frame.orientation * here.force);
        check_near(there.torque, frame.orientation * here.torque);
    }
}

TEST_CASE("no guide exceeds its largest force, however far or fast the hand is") {
    const Random random{3};
    for (const Guide& guide : guides()) {
        const bool is_dial = guide.type == std::string("dial");
        NodeHarness node(guide.type, test::servo);
        for (const auto& [name, text] : guide.settings) node.set(name, text);
        node.set(is_dial ? "max_torque" : "max_force", is_dial ? "0.05 N m" : "1.5 N").disconnect("frame");
        node.set("stiffness", is_dial ? "20 N m/rad" : "20 N/mm");
        const auto vector = [&](std::int64_t k, std::uint64_t n) {
            const auto at = 100 * static_cast<std::uint64_t>(k) + 3 * n;
            return Vec3(random.normal(at), random.normal(at + 1), random.normal(at + 2));
        };
        node.feed<Pose>("pose", [&](std::int64_t k) {
            return Pose{vector(k, 1) * std::pow(10.0, k % 6 - 4.0), rotation_by(vector(k, 2))};
        });
        node.feed<Twist>("twist", [&](std::int64_t k) {
            return Twist{vector(k, 3) * std::pow(10.0, k % 7 - 3.0), vector(k, 4) * std::pow(10.0, k % 5 - 1.0)};
        });
        node.prepare();
        node.run(3000);
        double most = 0.0;
        for (const Wrench& w : node.values<Wrench>("wrench"))
            most = std::max(most, is_dial ? glm::length(w.torque) : glm::length(w.force));
        CAPTURE(guide.type, most);
        CHECK(most <= (is_dial ? 0.05 : 1.5) * (1.0 + 1e-9));
        CHECK(most > (is_dial ? 0.04 : 1.0));
    }
}

TEST_CASE("a hand that draws closed curves through a guide gets no more energy than sampling explains") {
    for (const Guide& guide : guides())
        for (const simulate::DeviceModel& model : devices()) {
            const Loop loop = drawn(guide, model, false, 4.0), damped = drawn(guide, model, true, 4.0);
            CAPTURE(guide.type, &guide - guides().data(), model.name, loop.work, loop.explained, loop.most,
                    damped.work);
            CHECK(loop.work <= loop.explained);
            CHECK(loop.most > 0.01);
            // With the damping that it has by default less comes back; nothing does where sampling is all that is late.
            CHECK(damped.work < loop.work);
            if (model.name == "ideal") CHECK(damped.work < 0.0);
        }
}

TEST_CASE("guides keep to what sampling explains from 250 Hz to 2 kHz") {
    for (const Guide& guide : guides())
        for (const int rate : {250, 500, 2000}) {
            const simulate::DeviceModel ideal = devices().front();
            const Loop loop = drawn(guide, ideal, false, 2.0, rate), damped = drawn(guide, ideal, true, 2.0, rate);
            CAPTURE(guide.type, &guide - guides().data(), rate, loop.work, loop.explained, damped.work);
            CHECK(loop.work <= loop.explained);
            CHECK(damped.work <= loop.explained);
        }
}

TEST_CASE("no guide turns its force at once while the hand moves slowly") {
    for (const Guide& guide : guides()) {
        if (guide.type == std::string("dial")) continue;
        NodeHarness node(guide.type, test::servo);
        for (const auto& [name, text] : guide.settings) node.set(name, text);
        node.disconnect("frame");
        // 0.1 m/s at most, through all of the shape.
        const auto at = [](std::int64_t k) {
            const double t = 1e-3 * static_cast<double>(k);
            return Vec3(9.0 * mm * std::sin(5.0 * t), 5.0 * mm * std::sin(7.3 * t + 0.3), 4.0 * mm * std::sin(9.1 * t));
        };
        node.feed<Pose>("pose", [&](std::int64_t k) { return Pose{at(k), {1.0, 0.0, 0.0, 0.0}}; });
        node.feed<Twist>("twist", [&](std::int64_t k) { return Twist{(at(k + 1) - at(k)) / 1e-3, {}}; });
        node.prepare();
        node.run(8000);
        const auto out = node.values<Wrench>("wrench");
        double most = 0.0, largest = 0.0;
        for (std::size_t k = 1; k < out.size(); ++k) {
            most = std::max(most, glm::distance(out[k].force, out[k - 1].force));
            largest = std::max(largest, glm::length(out[k].force));
        }
        CAPTURE(guide.type, &guide - guides().data(), most, largest);
        CHECK(largest > 0.2);
        CHECK(most < 0.3);
    }
}

TEST_CASE("drag is against the velocity, within its largest force, and always takes") {
    NodeHarness node("viscosity", test::servo);
    node.set("damping", "5 N s/m").set("angular_damping", "0.01 N m s/rad").set("max_force", "1 N");
    node.feed<Twist>(
        "twist", [](std::int64_t k) { return Twist{{0.02 * static_cast<double>(k), 0.0, -0.01}, {0.0, 1.0, 0.0}}; });
    node.prepare();
    node.run(100);
    const auto out = node.values<Wrench>("wrench");
    check_near(out[5].force, {-0.5, 0.0, 0.05});
    check_near(out[5].torque, {0.0, -0.01, 0.0});
    for (const Wrench& w : out) CHECK(glm::length(w.force) <= 1.0 + 1e-12);
    CHECK(glm::length(out[99].force) == Approx(1.0));
}

TEST_CASE("a hand that nobody sees feels no guide") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Guide& guide : guides()) {
        const Wrench lost = felt(guide.type, guide.settings, {{nan, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}});
        const Wrench none = felt(guide.type, guide.settings, {{}, {0.0, 0.0, 0.0, 0.0}});
        CHECK(lost.force == Vec3(0.0));
        CHECK(none.torque == Vec3(0.0));
    }
    check_near(force("point_guide", {}, {2.0 * mm, 0.0, 0.0}, {nan, 0.0, 0.0}), {-1.0, 0.0, 0.0});
}

TEST_CASE("a guide without a shape is refused") {
    const auto refusal = [](const char* type, const char* name, const char* text) -> std::string {
        NodeHarness node(type, test::servo);
        try {
            node.set(name, text);
            node.prepare();
        } catch (const Error& error) {
            return error.what();
        }
        return "accepted";
    };
    CHECK_THAT(refusal("line_guide", "direction", "0, 0, 0"), ContainsSubstring("'direction' needs a length"));
    CHECK_THAT(refusal("box_guide", "size", "0 mm, 1 mm, 1 mm"), ContainsSubstring("above 0"));
    CHECK_THAT(refusal("path_guide", "points", "0 0 0 mm"), ContainsSubstring("two points"));
    CHECK_THAT(refusal("path_guide", "points", "0 0 0, 1 0 0"), ContainsSubstring("length as unit"));
    CHECK_THAT(refusal("path_guide", "points", "0 0, 1 0 mm"), ContainsSubstring("three coordinates"));
    CHECK_THAT(refusal("path_guide", "points", "mm"), ContainsSubstring("needs points"));
    CHECK(refusal("path_guide", "points", "0 0 0, 1 0 2 cm") == "accepted");
}
