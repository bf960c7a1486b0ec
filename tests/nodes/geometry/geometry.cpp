// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/times.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr double right = std::numbers::pi / 2.0;

const Pose somewhere{{0.1, -0.2, 0.3}, rotation_by(Vec3(0.3, -0.8, 0.5))};
const Pose elsewhere{{-0.4, 0.1, 0.7}, rotation_by(Vec3(-1.1, 0.2, 0.9))};

double off(const Vec3& a, const Vec3& b) { return glm::length(a - b); }
double off(const Pose& a, const Pose& b) {
    return off(a.position, b.position) + glm::length(rotation_between(a.orientation, b.orientation));
}

template <class Out>
Out result(NodeHarness& node, const std::string& port = "out") {
    node.prepare();
    node.run(1);
    return node.last<Out>(port);
}

NodeHarness& with(NodeHarness& node, const Pose& in) { return node.feed("in", in); }

}  // namespace

TEST_CASE("a pose composed with its inverse is the identity") {
    NodeHarness inverse("inverse", {.period = ms});
    const Pose back = result<Pose>(with(inverse, somewhere));
    NodeHarness compose("compose", {.period = ms});
    compose.feed("outer", somewhere).feed("inner", back);
    CHECK(off(result<Pose>(compose), Pose{}) < 1e-12);
    // In the frame of `somewhere`, and then where that is.
    NodeHarness both("compose", {.period = ms});
    both.feed("outer", somewhere).feed("inner", elsewhere);
    const Pose whole = result<Pose>(both);
    const Vec3 point(0.05, 0.02, -0.07);
    CHECK(off(whole.apply(point), somewhere.apply(elsewhere.apply(point))) < 1e-12);
}

TEST_CASE("what is split and joined again is the same") {
    NodeHarness split("split_pose", {.period = ms});
    split.feed("in", somewhere);
    const Vec3 rotation = result<Vec3>(split, "rotation");
    CHECK(off(rotation, Vec3(0.3, -0.8, 0.5)) < 1e-12);
    NodeHarness join("join_pose", {.period = ms});
    join.feed("position", split.last<Vec3>("position")).feed("rotation", rotation);
    CHECK(off(result<Pose>(join), somewhere) < 1e-12);

    const Wrench wrench{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
    NodeHarness forces("split_wrench", {.period = ms});
    forces.feed("in", wrench);
    CHECK(result<Vec3>(forces, "force") == wrench.force);
    CHECK(forces.last<Vec3>("torque") == wrench.torque);
    NodeHarness whole("join_wrench", {.period = ms});
    whole.feed("force", wrench.force).disconnect("torque");
    CHECK(result<Wrench>(whole).force == wrench.force);
    CHECK(whole.last<Wrench>("out").torque == Vec3(0.0));

    NodeHarness parts("split_vector", {.period = ms});
    parts.feed("in", Vec3(1.0, -2.0, 3.0));
    CHECK(result<double>(parts, "y") == -2.0);
    NodeHarness vector("join_vector", {.period = ms});
    vector.feed("x", 1.0).feed("z", 3.0).disconnect("y");
    CHECK(result<Vec3>(vector) == Vec3(1.0, 0.0, 3.0));

    NodeHarness moves("split_twist", {.period = ms});
    moves.feed("in", Twist{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}});
    CHECK(result<Vec3>(moves, "angular") == Vec3(4.0, 5.0, 6.0));
    NodeHarness twist("join_twist", {.period = ms});
    twist.feed("linear", Vec3(1.0, 2.0, 3.0)).feed("angular", Vec3(4.0, 5.0, 6.0));
    CHECK(result<Twist>(twist).linear == Vec3(1.0, 2.0, 3.0));
}

TEST_CASE("products, lengths and angles of vectors") {
    const Vec3 a(1.0, 2.0, 3.0), b(-2.0, 0.5, 4.0);
    NodeHarness dot("dot", {.period = ms});
    dot.feed("a", a).feed("b", b);
    CHECK(result<double>(dot) == Approx(11.0));
    NodeHarness cross("cross", {.period = ms});
    cross.feed("a", a).feed("b", b);
    CHECK(off(result<Vec3>(cross), Vec3(6.5, -10.0, 4.5)) < 1e-12);
    NodeHarness unit("normalise", {.period = ms});
    unit.feed("in", Vec3(0.0, 3e-200, 4e-200));
    CHECK(off(result<Vec3>(unit, "direction"), Vec3(0.0, 0.6, 0.8)) < 1e-12);
    CHECK(unit.last<double>("length") == Approx(5e-200));
    NodeHarness none("normalise", {.period = ms});
    none.feed("in", Vec3(0.0));
    CHECK(result<Vec3>(none, "direction") == Vec3(1.0, 0.0, 0.0));
    NodeHarness small("angle", {.period = ms});
    small.feed("a", Vec3(1.0, 0.0, 0.0)).feed("b", Vec3(2.0, 2e-9, 0.0));
    CHECK(result<double>(small) == Approx(1e-9));
    NodeHarness flat("angle", {.period = ms});
    flat.feed("a", Vec3(1.0, 0.0, 0.0)).feed("b", Vec3(-3.0, 0.0, 0.0));
    CHECK(result<double>(flat) == Approx(std::numbers::pi));
}

TEST_CASE("distance of two poses is that of their positions, and the angle that of the shortest rotation") {
    const Pose turned{somewhere.position + Vec3(3e-3, 0.0, -4e-3),
                      rotation_by(Vec3(0.0, 0.0, 0.4)) * somewhere.orientation};
    NodeHarness node("distance", {.period = ms});
    node.feed("from", somewhere).feed("to", turned);
    CHECK(result<double>(node, "distance") == Approx(5e-3));
    CHECK(node.last<double>("angle") == Approx(0.4));
    CHECK(off(node.last<Vec3>("offset"), Vec3(3e-3, 0.0, -4e-3)) < 1e-12);
}

TEST_CASE("look_at points z to the other position and keeps its orientation where there is no direction") {
    NodeHarness node("look_at", {.period = ms});
    node.feed("from", Vec3(1.0, 1.0, 1.0)).feed<Vec3>("to", [](std::int64_t k) {
        return k == 0 ? Vec3(1.0, 3.0, 1.0) : Vec3(1.0, 1.0, 1.0);
    });
    node.prepare();
    node.run(1);
    const Pose out = node.last<Pose>("out");
    CHECK(off(out.rotate(Vec3(0.0, 0.0, 1.0)), Vec3(0.0, 1.0, 0.0)) < 1e-12);
    CHECK(off(out.rotate(Vec3(0.0, 1.0, 0.0)), Vec3(0.0, 0.0, 1.0)) < 1e-12);
    CHECK(is_valid(out));
    node.run(1);
    CHECK(off(node.last<Pose>("out"), out) < 1e-12);
}

TEST_CASE("a vector turned to world axes and back is the same, a point too") {
    const Wrench wrench{{1.0, 2.0, 3.0}, {-4.0, 5.0, 0.5}};
    NodeHarness there("rotate", {.period = ms, .any = &value::wrench});
    there.feed("in", wrench).feed("by", somewhere);
    const Wrench turned = result<Wrench>(there);
    CHECK(off(turned.torque, somewhere.orientation * wrench.torque) < 1e-12);
    NodeHarness back("rotate", {.period = ms, .any = &value::wrench});
    back.set("to", "local").feed("in", turned).feed("by", somewhere);
    CHECK(off(result<Wrench>(back).force, wrench.force) < 1e-12);
    NodeHarness point("transform_point", {.period = ms});
    point.feed("in", Vec3(0.01, 0.02, 0.03)).feed("frame", somewhere);
    const Vec3 world = result<Vec3>(point);
    CHECK(off(world, somewhere.apply(Vec3(0.01, 0.02, 0.03))) < 1e-12);
    NodeHarness local("transform_point", {.period = ms});
    local.set("to", "local").feed("in", world).feed("frame", somewhere);
    CHECK(off(result<Vec3>(local), Vec3(0.01, 0.02, 0.03)) < 1e-12);
}

TEST_CASE("between two poses lies half of the shortest rotation") {
    const Pose quarter{{0.2, 0.0, 0.0}, rotation_by(Vec3(0.0, 0.0, right))};
    NodeHarness node("interpolate", {.period = ms, .any = &value::pose});
    node.feed("a", Pose{}).feed("b", quarter);
    const Pose half = result<Pose>(node);
    CHECK(off(half, Pose{{0.1, 0.0, 0.0}, rotation_by(Vec3(0.0, 0.0, right / 2.0))}) < 1e-12);
}

TEST_CASE("a sum of wrenches has the power of its parts, whatever point it refers to") {
    // The power of a rigid body's wrenches is that of their sum at any point of the body: F·v + T·ω.
    const Vec3 spin(0.7, -1.3, 2.0), speed_at_origin(0.2, 0.1, -0.4);
    const auto velocity = [&](const Vec3& at) { return speed_at_origin + glm::cross(spin, at); };
    const auto power = [&](const Wrench& w, const Vec3& at) {
        return glm::dot(w.force, velocity(at)) + glm::dot(w.torque, spin);
    };
    const Wrench first{{1.0, -2.0, 0.5}, {0.1, 0.0, -0.3}}, second{{-4.0, 1.0, 2.0}, {0.0, 0.2, 0.1}};
    for (const Pose& point : {Pose{}, Pose{{0.3, 0.2, -0.1}, rotation_by(Vec3(1.0, 0.0, 0.0))}}) {
        NodeHarness sum("wrench_sum", {.period = ms});
        sum.disconnect_optional();
        sum.feed("in1", first)
            .feed("about1", somewhere)
            .feed("in2", second)
            .feed("about2", elsewhere)
            .feed("point", point);
        for (const char* wired : {"in1", "about1", "in2", "about2", "point"}) sum.connect(wired);
        const Wrench whole = result<Wrench>(sum);
        CHECK(power(whole, point.position) ==
              Approx(power(first, somewhere.position) + power(second, elsewhere.position)));
    }
    // Without points the parts are added as they are.
    NodeHarness plain("wrench_sum", {.period = ms});
    plain.disconnect_optional();
    plain.feed("in1", first).feed("in2", second).connect("in1").connect("in2");
    CHECK(result<Wrench>(plain).torque == first.torque + second.torque);
}
