// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/shape.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

using namespace tactus;
using test::NodeHarness;

namespace {

/// Place 0: a table of 40 × 40 × 10 mm, top at z = 0. Place 1: a box of 10 mm that floats 1 mm above it.
const coupling::Scene& coupled_scene() {
    const auto part = [](const contact::Box& box, double spacing, double voxel) {
        volume::Grid grid{{0, 0, 0}, box.low() - Vec3(3.0 * mm), Vec3(voxel), {}};
        for (int axis = 0; axis < 3; ++axis)
            grid.size[static_cast<std::size_t>(axis)] =
                static_cast<int>(std::ceil((box.size[axis] + 6.0 * mm) / voxel)) + 1;
        return std::pair(contact::make_pointshell(box.points(spacing)),
                         contact::sample_voxmap(grid, [&](const Vec3& p) { return box.distance(p); }));
    };
    static const auto table = part({Vec3(40.0, 40.0, 10.0) * mm}, 2.0 * mm, 0.5 * mm);
    static const auto box = part({Vec3(10.0 * mm)}, 1.0 * mm, 0.5 * mm);
    static const geometry::TriangleTree top(geometry::iso_surface(table.second.grid, 0.0f, false));
    static const coupling::Scene scene = [] {
        coupling::Scene made;
        made.count = 2;
        made.objects[0] = {{&table.first, &table.second, &top, {}, 1, 1}, {{0.0, 0.0, -5.0 * mm}, {1, 0, 0, 0}}};
        made.objects[1] = {{&box.first, &box.second, nullptr, {}, 1, 2}, {{0.0, 0.0, 6.0 * mm}, {1, 0, 0, 0}}};
        made.version = 1;
        made.content_hash = coupling::hash_of(made);
        return made;
    }();
    return scene;
}

}  // namespace

TEST_CASE("a held box set down on a table is felt with the coupling's stiffness, and the box stands on it") {
    NodeHarness node("quasi_static_coupling", test::servo);
    node.set("held", "1").set("grip_at", "0 mm, 0 mm, -20 mm");
    node.feed("scene", coupled_scene());
    node.feed<Pose>("device", [](std::int64_t k) {
        return Pose{{0.0, 0.0, std::max(25.0 * mm - 0.05 * mm * static_cast<double>(k), 22.0 * mm)}, {1, 0, 0, 0}};
    });
    node.disconnect_optional();
    node.prepare();
    node.run(200);
    // 3 mm deep, in series with over 100 mm² of 40 N/mm each.
    const Wrench w = node.last<Wrench>("wrench");
    CHECK(w.force.z == Approx(3.0).epsilon(0.01));
    CHECK(std::hypot(w.force.x, w.force.y) < 1e-3);
    CHECK(node.last<Pose>("pose").position.z == Approx(5.0 * mm).margin(0.05 * mm));
    CHECK(node.last<bool>("in_contact"));
    const Report report = node.report();
    CHECK(std::get<double>(report.sections.at("coupling").at("residual_p99_N")) < 2e-3);
    CHECK(std::get<double>(report.sections.at("coupling").at("penetration_max_mm")) < 0.1);
}

TEST_CASE("a body is taken and let go at any point without a jump in force") {
    NodeHarness grasp("grasp", test::servo), coupling("quasi_static_coupling", test::servo);
    // Taken at a corner, carried down on the table, pressed, and let go while pressed.
    const auto hand = [](std::int64_t k) {
        const double down = std::clamp(0.02 * mm * static_cast<double>(k - 300), 0.0, 4.0 * mm);
        return Pose{{4.0 * mm, 3.0 * mm, 12.0 * mm - down}, rotation_by({0.3, -0.2, 1.0})};
    };
    grasp.feed<Pose>("hand", hand);
    grasp.feed("scene", coupled_scene());
    grasp.feed<bool>("trigger", [](std::int64_t k) { return k >= 100 && k < 900; });
    grasp.disconnect("release");
    grasp.prepare();
    grasp.run(1200);
    const auto held = grasp.values<double>("held");
    const auto grips = grasp.values<Pose>("grip");
    const auto holding = grasp.values<bool>("holding");
    const auto strength = grasp.values<double>("strength");
    CHECK(held[50] == -1.0);
    CHECK(held[101] == 1.0);
    CHECK(held[1100] == -1.0);
    const Pose there = hand(100) * grips[100];
    CHECK(glm::length(there.position - coupled_scene().objects[1].pose.position) < 1e-12);

    const auto at = [](std::int64_t k) { return static_cast<std::size_t>(k); };
    coupling.feed<Pose>("device", hand);
    coupling.feed("scene", coupled_scene());
    coupling.feed<Pose>("grip", [&](std::int64_t k) { return grips[at(k)]; });
    coupling.feed<bool>("holding", [&](std::int64_t k) { return bool(holding[at(k)]); });
    coupling.feed<double>("strength", [&](std::int64_t k) { return strength[at(k)]; });
    // A number cannot be fed to a parameter here: the place is held from the first tick on, but not the body.
    coupling.set("held", "1");
    coupling.disconnect("target")
        .disconnect("guided")
        .disconnect("has_target")
        .disconnect("target_of")
        .disconnect("settle");
    coupling.prepare();
    coupling.run(1200);
    const auto felt = coupling.values<Wrench>("wrench");
    double step = 0.0, most = 0.0;
    for (std::size_t k = 1; k < felt.size(); ++k) {
        step = std::max(step, glm::length(felt[k].force - felt[k - 1].force));
        most = std::max(most, glm::length(felt[k].force));
    }
    CHECK(most > 2.0);
    CHECK(step < 0.1);
    CHECK(glm::length(felt.back().force) == 0.0);
    CHECK(glm::length(felt[100].force) < 1e-3);
    // It stays where it was let go.
    const auto pose = coupling.values<Pose>("pose");
    CHECK(pose[1199].position == pose[900].position);
}

TEST_CASE("a scene keeps a body where a hand has put it") {
    NodeHarness node("scene", test::servo);
    const coupling::Scene& sample = coupled_scene();
    node.feed("a", sample.objects[0].body);
    node.feed("b", sample.objects[1].body);
    node.disconnect("c").disconnect("d").disconnect("a_pose").disconnect("b_pose").disconnect("c_pose");
    node.disconnect("d_pose");
    node.set("b_at", "0 mm, 0 mm, 6 mm");
    node.feed<double>("which", [](std::int64_t k) { return k >= 10 && k < 20 ? 1.0 : -1.0; });
    node.feed("moved", Pose{{0.01, 0.02, 0.03}, {1, 0, 0, 0}});
    node.prepare();
    node.run(30);
    const auto scenes = node.values<coupling::Scene>("scene");
    CHECK(scenes[5].count == 2);
    CHECK(scenes[5].objects[1].pose.position == Vec3(0.0, 0.0, 6.0 * mm));
    CHECK(scenes[29].objects[1].pose.position == Vec3(0.01, 0.02, 0.03));
    CHECK(scenes[29].objects[0].pose.position == Vec3(0.0));
    CHECK(scenes[29].content_hash != scenes[5].content_hash);
}

TEST_CASE("direct rendering scales all points together to what the hand can feel") {
    NodeHarness contact("voxmap_contact", test::servo), direct("direct_coupling", test::servo);
    contact.set("held", "1");
    contact.feed("scene", coupled_scene());
    contact.feed("pose", Pose{{0.0, 0.0, 4.5 * mm}, {1, 0, 0, 0}});
    contact.prepare();
    contact.run(1);
    const Wrench raw = contact.last<Wrench>("wrench");
    // 100 mm² of the lower face and 20 mm² of the edges, 40 N/mm for each.
    CHECK(raw.force.z == Approx(120 * 40e3 * 0.5 * mm).epsilon(0.01));
    direct.feed("contact", raw);
    direct.feed("contact_stiffness", contact.last<double>("stiffness"));
    direct.set("stiffness", "0.8 N/mm");
    direct.prepare();
    direct.run(1);
    CHECK(direct.last<Wrench>("wrench").force.z == Approx(0.4).epsilon(0.02));
}

TEST_CASE("direct rendering of a saturated contact keeps the force of its onset") {
    for (const char* stiffness : {"0 N/mm", "10 N/mm"})
        for (const double speed : {1.0, 50.0}) {  // mm/s
            NodeHarness contact("voxmap_contact", test::servo), direct("direct_coupling", test::servo);
            contact.set("held", "1").set("saturation", "0.3 mm").set("point_stiffness", stiffness);
            contact.feed("scene", coupled_scene());
            const auto depth = [speed](std::int64_t k) {
                return std::min(1e-3 * speed * static_cast<double>(k), 0.8) - 0.1;
            };
            contact.feed<Pose>("pose",
                               [&](std::int64_t k) { return Pose{{0.0, 0.0, (5.0 - depth(k)) * mm}, {1, 0, 0, 0}}; });
            contact.prepare();
            contact.run(900);
            const auto forces = contact.values<Wrench>("wrench");
            const auto stiffnesses = contact.values<double>("stiffness");
            direct.feed<Wrench>("contact", [&](std::int64_t k) { return forces[static_cast<std::size_t>(k)]; });
            direct.feed<double>("contact_stiffness",
                                [&](std::int64_t k) { return stiffnesses[static_cast<std::size_t>(k)]; });
            direct.prepare();
            direct.run(900);
            double last = 0.0;
            for (const Wrench& felt : direct.values<Wrench>("wrench")) {
                const double force = glm::length(felt.force);
                CAPTURE(stiffness, speed, last, force);
                // 0.8 N/mm along all of the way, and what the blend of the surface adds.
                REQUIRE(std::abs(force - last) < 0.8 * 1e-3 * speed + 0.03);
                REQUIRE(force < 0.8 * 0.8);
                last = force;
            }
            CHECK(last > 0.05);
        }
}

TEST_CASE("a proxy node stops at the table, on its field and on its triangles") {
    for (const char* type : {"point_proxy", "sphere_proxy"})
        for (const char* surface : {"field", "triangles"}) {
            NodeHarness node(type, test::servo);
            node.set("surface", surface);
            coupling::Scene only = coupled_scene();
            only.count = 1;
            node.feed("scene", only);
            node.feed<Pose>("device", [](std::int64_t k) {
                return Pose{{1.0 * mm, 2.0 * mm, 5.0 * mm - 0.05 * mm * static_cast<double>(k)}, {1, 0, 0, 0}};
            });
            node.prepare();
            node.run(141);
            const double radius = type[0] == 's' ? 2.0 * mm : 0.0;
            CAPTURE(type, surface);
            CHECK(node.last<Wrench>("wrench").force.z == Approx(1000.0 * (2.0 * mm + radius)).epsilon(0.01));
            CHECK(node.last<bool>("in_contact"));
        }
}

TEST_CASE("a body with mass comes to rest on the table under the hand's springs") {
    NodeHarness node("dynamic_coupling", test::servo);
    node.set("held", "1");
    node.feed("scene", coupled_scene());
    node.feed<Pose>("device", [](std::int64_t k) {
        return Pose{{0.0, 0.0, std::max(6.0 * mm - 0.02 * mm * static_cast<double>(k), 3.0 * mm)}, {1, 0, 0, 0}};
    });
    node.disconnect_optional();
    node.prepare();
    node.run(1500);
    CHECK(node.last<Wrench>("wrench").force.z == Approx(2.0).epsilon(0.02));
}

TEST_CASE("a device that jumps gives no blow by the damper of a body with mass") {
    NodeHarness node("dynamic_coupling", test::servo);
    node.set("held", "1").set("stiffness", "0.1 N/mm");
    node.feed("scene", coupled_scene());
    node.feed<Pose>("device",
                    [](std::int64_t k) { return Pose{{0.0, 0.0, k < 50 ? 30.0 * mm : 60.0 * mm}, {1, 0, 0, 0}}; });
    node.disconnect_optional();
    node.prepare();
    node.run(200);
    double most = 0.0;
    for (const Wrench& w : node.values<Wrench>("wrench")) most = std::max(most, glm::length(w.force));
    CHECK(most > 1.0);
    CHECK(most < 4.0);  // 30 mm of 0.1 N/mm, not 30 m/s of 10 N s/m
}

TEST_CASE("a shaped wrench stays below its limits and keeps its direction") {
    NodeHarness node("force_shaping", test::servo);
    node.feed("in", Wrench{{30.0, 40.0, 0.0}, {0.0, 0.0, 3.0}});
    node.prepare();
    node.run(1);
    const Wrench w = node.last<Wrench>("wrench");
    CHECK(glm::length(w.force) < 10.0);
    CHECK(glm::length(w.force) > 9.9);
    CHECK(w.force.y / w.force.x == Approx(4.0 / 3.0));
    CHECK(w.torque.z <= 0.5);
}

TEST_CASE("a device of three degrees of freedom is given no torque and says so") {
    NodeHarness node("device_output", test::servo);
    DevicePort& port = node.host.device("", DeviceUse::drive, {});
    port.info.actuates_torque = false;
    node.feed<Wrench>("wrench",
                      [](std::int64_t k) { return k < 200 ? Wrench{} : Wrench{{0.0, 0.0, 1.0}, {0.0, 0.2, 0.0}}; });
    node.device_feed = [](std::int64_t k, DevicePort& p) {
        p.sample = {};
        p.sample.counter = k;
        p.sample.valid = true;
    };
    node.prepare();
    node.run(600);
    CHECK(node.last<Wrench>("applied").force.z == Approx(1.0));
    CHECK(node.last<Wrench>("applied").torque == Vec3(0.0));
    CHECK(node.last<bool>("torque_dropped"));
    CHECK_FALSE(node.values<bool>("torque_dropped")[100]);
    CHECK(std::get<double>(node.report().sections.at("force").at("torque_dropped_max_Nm")) == Approx(0.2));
}

TEST_CASE("the torque of a spring has no jump at half a turn, and does no work on a full one") {
    for (const char* type : {"spring", "hand_coupling"}) {
        const bool is_spring = std::string_view(type) == "spring";
        NodeHarness node(type, test::servo);
        node.set("angular_stiffness", "2 N m/rad").disconnect_optional();
        constexpr int steps = 3600;
        const auto angle = [](std::int64_t k) { return 2.0 * M_PI * static_cast<double>(k) / steps; };
        const Vec3 axis = glm::normalize(Vec3(1.0, -2.0, 0.5));
        node.feed<Pose>(is_spring ? "device" : "a",
                        [&](std::int64_t k) { return Pose{{}, rotation_by(angle(k) * axis)}; });
        node.feed(is_spring ? "object" : "b", Pose{});
        node.prepare();
        node.run(steps + 1);
        const auto torque = node.values<Wrench>(is_spring ? "wrench" : "on_a");
        double jump = 0.0, work = 0.0, largest = 0.0;
        for (std::size_t k = 1; k < torque.size(); ++k) {
            jump = std::max(jump, glm::length(torque[k].torque - torque[k - 1].torque));
            work += 0.5 * glm::dot(torque[k].torque + torque[k - 1].torque, axis) * angle(1);
            largest = std::max(largest, glm::length(torque[k].torque));
        }
        CAPTURE(type, jump, work, largest);
        CHECK(glm::length(torque[600].torque - axis * (-2.0 * angle(600))) < 1e-9);
        CHECK(largest == Approx(1.5 * M_PI).epsilon(1e-3));
        CHECK(jump < 3.01 * 2.0 * angle(1));
        CHECK(std::abs(work) < 1e-6);
    }
}

TEST_CASE("a force that is not finite passes every node that smooths forces, so that the hand's output sees it") {
    for (const char* type : {"smooth", "slew", "force_shaping"}) {
        const bool is_shaping = std::string_view(type) == "force_shaping";
        NodeHarness node = is_shaping ? NodeHarness(type, test::servo)
                                      : NodeHarness(type, {.period = test::servo.period, .any = &value::wrench});
        if (std::string_view(type) == "slew") node.set("rise", "1e6 1/s").set("fall", "1e6 1/s");
        node.feed<Wrench>("in", [](std::int64_t k) {
            return Wrench{{0.0, 0.0, k == 100 ? std::numeric_limits<double>::quiet_NaN() : 3.0}, {}};
        });
        node.prepare();
        node.run(102);
        const auto out = node.values<Wrench>(is_shaping ? "wrench" : "out");
        CAPTURE(type);
        CHECK(out[99].force.z == Approx(3.0));
        CHECK_FALSE(is_finite(out[100]));
        // It goes on as before.
        CHECK(out[101].force.z == Approx(3.0));
    }
}

TEST_CASE("a force whose changes overflow is felt as a fault in its ticks, and never after them") {
    for (const char* type : {"smooth", "slew", "force_shaping"}) {
        const bool is_shaping = std::string_view(type) == "force_shaping";
        NodeHarness node = is_shaping ? NodeHarness(type, test::servo)
                                      : NodeHarness(type, {.period = test::servo.period, .any = &value::wrench});
        if (std::string_view(type) == "slew") node.set("rise", "1e6 1/s").set("fall", "1e6 1/s");
        if (is_shaping) node.set("cutoff", "100 Hz");
        node.feed<Wrench>("in", [](std::int64_t k) {
            const double huge = 0.9 * std::numeric_limits<double>::max();
            return Wrench{{0.0, 0.0, k == 100 ? huge : k == 101 ? -huge : 3.0}, {}};
        });
        node.prepare();
        node.run(200);
        const auto out = node.values<Wrench>(is_shaping ? "wrench" : "out");
        CAPTURE(type);
        if (is_shaping) CHECK_FALSE(is_finite(out[101]));
        for (std::size_t k = 102; k < out.size(); ++k) REQUIRE(is_finite(out[k]));
        CHECK(out.back().force.z == Approx(3.0));
    }
}

namespace {

/// A hand that goes down to the table and presses the held body on it.
Pose pressed(std::int64_t k) {
    return {{0.0, 0.0, std::max(25.0 * mm - 0.05 * mm * static_cast<double>(k), 22.0 * mm)}, {1, 0, 0, 0}};
}

void press_on_table(NodeHarness& node) {
    node.set("held", "1").set("grip_at", "0 mm, 0 mm, -20 mm");
    node.feed("scene", coupled_scene()).feed<Pose>("device", pressed);
}

}  // namespace

TEST_CASE("a body that is let go leaves no force on the hand, where nothing states the strength of its force") {
    for (const char* type : {"quasi_static_coupling", "dynamic_coupling"}) {
        NodeHarness node(type, test::servo);
        press_on_table(node);
        node.feed<bool>("holding", [](std::int64_t k) { return k < 300; });
        node.disconnect_optional().connect("holding");
        node.prepare();
        node.run(500);
        const auto felt = node.values<Wrench>("wrench");
        double step = 0.0;
        for (std::size_t k = 300; k < felt.size(); ++k)
            step = std::max(step, glm::length(felt[k].force - felt[k - 1].force));
        CAPTURE(type);
        CHECK(felt[299].force.z > 2.0);
        CHECK(step < 0.02 * felt[299].force.z);
        CHECK(glm::length(felt[401].force) == 0.0);
        CHECK(glm::length(felt.back().force) == 0.0);
    }
}

TEST_CASE("a released body leaves no force on the hand where its strength is wired to something that does not fall") {
    for (const char* type : {"quasi_static_coupling", "dynamic_coupling"}) {
        NodeHarness node(type, test::servo);
        press_on_table(node);
        node.feed<bool>("holding", [](std::int64_t k) { return k < 300; });
        node.disconnect_optional().connect("holding").feed<double>("strength", 0.5).connect("strength");
        node.prepare();
        node.run(1400);
        const auto felt = node.values<Wrench>("wrench");
        CAPTURE(type);
        CHECK(felt[299].force.z > 1.0);
        CHECK(glm::length(felt[310].force) > 0.9 * felt[299].force.z);
        CHECK(glm::length(felt[1301].force) == 0.0);
        CHECK(glm::length(felt.back().force) == 0.0);
    }
}

TEST_CASE("a coupling gives no force while the pose of its hand is none, and goes on from the last one that was") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const char* type : {"quasi_static_coupling", "dynamic_coupling"}) {
        NodeHarness node(type, test::servo);
        press_on_table(node);
        node.feed<Pose>("device", [](std::int64_t k) {
            return k >= 300 && k < 400 ? Pose{{nan, 0.0, 0.0}, {1, 0, 0, 0}} : pressed(k);
        });
        node.disconnect_optional();
        node.prepare();
        node.run(500);
        const auto felt = node.values<Wrench>("wrench");
        CAPTURE(type);
        REQUIRE(felt[299].force.z > 2.0);
        for (std::size_t k = 300; k < 400; ++k) REQUIRE(glm::length(felt[k].force) == 0.0);
        CHECK(felt.back().force.z == Approx(felt[299].force.z).epsilon(0.05));
    }
}

TEST_CASE("a body whose pose is none for a tick stays where it was") {
    NodeHarness node("scene", test::servo);
    node.feed("a", coupled_scene().objects[0].body);
    for (const char* other : {"b", "c", "d", "b_pose", "c_pose", "d_pose"}) node.disconnect(other);
    node.feed<double>("which", -1.0).feed("moved", Pose{{0.0, 0.0, 0.0}, {1, 0, 0, 0}});
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    node.feed<Pose>("a_pose", [](std::int64_t k) {
        return k == 50 ? Pose{{nan, 0.0, 0.0}, {1, 0, 0, 0}}
                       : Pose{{0.1 + 1e-4 * static_cast<double>(k), 0.0, 0.0}, {1, 0, 0, 0}};
    });
    node.prepare();
    node.run(60);
    const auto scenes = node.values<coupling::Scene>("scene");
    CHECK(scenes[50].objects[0].pose.position.x == Approx(0.1049));
    CHECK(scenes[51].objects[0].pose.position.x == Approx(0.1051));
}
