// SPDX-License-Identifier: Apache-2.0
// No contact node may do work on a hand that comes back to where it started, beyond what sampling explains.
//
// A force F that is held for a tick while the hand moves by d does F·d work; half of the forces at both ends would do
// (F + F')/2·d, whose sum over a closed path is zero for a conservative force and negative with friction and dampers.
// Sampling therefore explains ½·|(F' − F)·d| per tick, and of that no more than ½·K·|d|² for a node whose stiffness stays
// below K: in all ½·K·T·∫v² dt for the period T, which vanishes with T. A jump in force is not excused. To that bound
// comes a tolerance times the path length, that of a solver or the rounding of the contact kernel, and 2 % for the kinks
// of the force where points touch. A damper D counts as D/T in K.
#include "assets/library/fragments.hpp"
#include "dsp/contact/shape.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "dsp/volume/bricks.hpp"
#include "nodes/catalogue.hpp"
#include "tests/nodes/contact/closed_paths.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

using namespace tactus;
using test::eased;
using test::Motion;
using test::motions;
using test::NodeHarness;

namespace {

const Quat upright(1.0, 0.0, 0.0, 0.0);

struct Part {
    contact::Pointshell shell;
    contact::Voxmap map;
    geometry::TriangleTree triangles;

    template <class Shape>
    Part(const Shape& shape, double spacing, double voxel)
        : shell(contact::make_pointshell(shape.points(spacing))),
          map(contact::voxmap_of(shape, voxel, 3.0 * mm)),
          triangles(geometry::iso_surface(map.grid, 0.0f, false)) {}
};

/// Place 0: a table of 16 × 16 × 10 mm, its top at z = 0. Place 1: a box of 10 mm.
const coupling::Scene& table_and_box() {
    static const Part table(contact::Box{Vec3(16.0, 16.0, 10.0) * mm}, 1.0 * mm, 0.5 * mm);
    static const Part box(contact::Box{Vec3(10.0 * mm)}, 1.0 * mm, 0.5 * mm);
    static const coupling::Scene scene = [] {
        coupling::Scene made;
        made.count = 2;
        made.objects[0] = {{&table.shell, &table.map, &table.triangles, {}, 1, 1}, {{0.0, 0.0, -5.0 * mm}, upright}};
        made.objects[1] = {{&box.shell, &box.map, &box.triangles, {}, 1, 2}, {{0.0, 0.0, 30.0 * mm}, upright}};
        made.content_hash = coupling::hash_of(made);
        return made;
    }();
    return scene;
}

coupling::Scene table_alone() {
    coupling::Scene scene = table_and_box();
    scene.count = 1;
    return scene;
}

/// A plate of bone of 12 × 12 mm and `thickness` m, its top at z = 0.
volume::BoneEditor plate(double thickness) {
    const contact::Box box{Vec3(12.0 * mm, 12.0 * mm, thickness)};
    volume::Grid distance{{40, 40, 40}, Vec3(-10.0 * mm, -10.0 * mm, -10.0 * mm), Vec3(0.5 * mm), {}};
    distance.values.resize(distance.count());
    volume::Grid density = distance;
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 40; ++j)
            for (int i = 0; i < 40; ++i) {
                distance.at(i, j, k) = static_cast<float>(box.distance(distance.position(i, j, k)));
                density.at(i, j, k) = 1600.0f;
            }
    distance.origin.z -= 0.5 * thickness;
    density.origin = distance.origin;
    return {distance, density, {.band = 0.1, .max_dirty = 1, .max_versions = 1}};
}

/// What a node feels like at most, and how to drive it.
struct Case {
    const char *type, *pose;
    double stiffness, angular = 0.0;  ///< K: N/m and N·m/rad, of the force that the hand feels
    double lever = 0.0;  ///< m: turns move the touching points by this much, for nodes without a coupling
    double tolerance = 1e-9;  ///< N, of a solver
    double depth = 2.0 * mm, turn = 0.2;
    double lift = 0.0;  ///< m, from the lower end of what is held to its origin
    Quat rest{1.0, 0.0, 0.0, 0.0};
    std::function<void(NodeHarness&)> set_up;
    bool wired = false;  ///< optional inputs stay connected
};

struct Cycle {
    double work = 0.0, bound = 0.0, most = 0.0;  ///< J, J, N
};

constexpr std::int64_t rest_ticks = 300;

std::vector<Pose> poses_of(const Motion& motion, double lift, std::int64_t ticks) {
    std::vector<Pose> poses;
    for (std::int64_t k = 0; k <= ticks + rest_ticks; ++k) {
        Pose pose = motion.path(std::clamp(static_cast<double>(k) / static_cast<double>(ticks), 0.0, 1.0));
        pose.position.z += lift;
        poses.push_back(pose);
    }
    return poses;
}

Cycle cycle_of(const std::vector<Pose>& poses, const std::vector<Wrench>& felt, const Case& c) {
    Cycle cycle;
    double length = 0.0;
    for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
        const Vec3 move = poses[k + 1].position - poses[k].position;
        const Vec3 turn = rotation_between(poses[k].orientation, poses[k + 1].orientation);
        cycle.work += glm::dot(felt[k].force, move) + glm::dot(felt[k].torque, turn);
        cycle.most = std::max(cycle.most, glm::length(felt[k].force));
        const double way = glm::length(move) + c.lever * glm::length(turn);
        length += way + 0.01 * glm::length(turn);
        const Wrench change = felt[k + 1] + felt[k] * -1.0;
        cycle.bound += 0.5 * std::min(std::abs(glm::dot(change.force, move) + glm::dot(change.torque, turn)),
                                      c.stiffness * way * way + c.angular * glm::dot(turn, turn));
    }
    cycle.bound = 1.02 * cycle.bound + c.tolerance * length;
    return cycle;
}

std::vector<Wrench> felt_by(const Case& c, const std::vector<Pose>& poses) {
    NodeHarness node(c.type, test::servo);
    node.feed<Pose>(c.pose, [&](std::int64_t k) { return poses[static_cast<std::size_t>(k)]; });
    c.set_up(node);
    if (!c.wired) node.disconnect_optional();
    node.prepare();
    node.run(static_cast<std::int64_t>(poses.size()));
    return node.values<Wrench>("wrench");
}

/// direct_coupling feels what voxmap_contact computes.
std::vector<Wrench> felt_directly(const Case& c, const std::vector<Pose>& poses) {
    NodeHarness contact("voxmap_contact", test::servo), direct("direct_coupling", test::servo);
    contact.feed<Pose>("pose", [&](std::int64_t k) { return poses[static_cast<std::size_t>(k)]; });
    contact.feed("scene", table_and_box()).set("held", "1");
    contact.prepare();
    contact.run(static_cast<std::int64_t>(poses.size()));
    const auto wrenches = contact.values<Wrench>("wrench");
    const auto stiffness = contact.values<double>("stiffness");
    direct.feed<Wrench>("contact", [&](std::int64_t k) { return wrenches[static_cast<std::size_t>(k)]; });
    direct.feed<double>("contact_stiffness", [&](std::int64_t k) { return stiffness[static_cast<std::size_t>(k)]; });
    c.set_up(direct);
    direct.prepare();
    direct.run(static_cast<std::int64_t>(poses.size()));
    return direct.values<Wrench>("wrench");
}

const std::vector<Case>& cases() {
    static const std::vector<Case> all = [] {
        const auto held = [](NodeHarness& n) { n.feed("scene", table_and_box()).set("held", "1"); };
        const auto proxied = [](const char* surface, const char* friction) {
            return [=](NodeHarness& n) {
                n.feed("scene", table_alone()).set("surface", surface);
                n.set("static_friction", friction).set("dynamic_friction", friction);
            };
        };
        const double body_stiffness = 200.0 * 40e3;  // at most so many mm² of 40 N/mm touch at once
        std::vector<Case> made{
            {.type = "sphere_contact",
             .pose = "pose",
             .stiffness = 800.0,
             .tolerance = 1e-5,
             .lift = 5.0 * mm,
             .set_up = [](NodeHarness& n) { n.set("centre", "0 mm, 0 mm, -50 mm"); }},
            {.type = "voxmap_contact",
             .pose = "pose",
             .stiffness = body_stiffness,
             .lever = 9.0 * mm,
             .tolerance = 1e-3,
             .depth = 0.5 * mm,
             .lift = 5.0 * mm,
             .set_up = held},
            {.type = "direct_coupling",
             .pose = "",
             .stiffness = 800.0,
             .lever = 9.0 * mm,
             .tolerance = 1e-6,
             .depth = 0.5 * mm,
             .lift = 5.0 * mm,
             .set_up = [](NodeHarness&) {}},
            {.type = "quasi_static_coupling",
             .pose = "device",
             .stiffness = 1000.0,
             .angular = 1.0,
             .tolerance = 2e-3,
             .lift = 5.0 * mm,
             .set_up = held},
            {.type = "dynamic_coupling",
             .pose = "device",
             .stiffness = 1000.0 + 10.0 / 1e-3,
             .angular = 1.0 + 0.01 / 1e-3,
             .tolerance = 2e-3,
             .lift = 5.0 * mm,
             .set_up = held},
            {.type = "dynamic_coupling",
             .pose = "device",
             .stiffness = 1000.0 + 60.0 / 1e-3,
             .angular = 1.0 + 0.1 / 1e-3,
             .tolerance = 2e-3,
             .lift = 5.0 * mm,
             .set_up =
                 [held](NodeHarness& n) {
                     held(n);
                     n.set("mass", "500 g").set("damping", "60 N s/m").set("angular_damping", "0.1 N m s/rad");
                 }},
            {.type = "quasi_static_coupling",
             .pose = "device",
             .stiffness = 4000.0,
             .angular = 4.0,
             .tolerance = 2e-3,
             .lift = 5.0 * mm,
             .set_up =
                 [held](NodeHarness& n) {
                     held(n);
                     n.set("both_ways", "true")
                         .set("interpolation", "quadratic")
                         .set("stiffness", "4 N/mm")
                         .set("angular_stiffness", "4 N m/rad");
                 }},
            {.type = "snap_to_fit",
             .pose = "device",
             .stiffness = 1000.0,
             .angular = 1.0,
             .tolerance = 2e-3,
             .lift = 5.0 * mm,
             .set_up =
                 [held](NodeHarness& n) {
                     n.asset("moving", test::sample_asset("bone")).asset("fixed", test::sample_asset("bone"));
                     held(n);
                 }},
        };
        // Guides: their top, or their middle, at z = 0. The hand is not damped: no velocity is wired.
        const auto guide = [](std::vector<std::pair<const char*, const char*>> settings) {
            return [=](NodeHarness& n) {
                for (const auto& [name, text] : settings) n.set(name, text);
            };
        };
        const auto add_guide = [&](const char* type, std::vector<std::pair<const char*, const char*>> settings) {
            made.push_back({.type = type, .pose = "pose", .stiffness = 500.0, .set_up = guide(std::move(settings))});
        };
        add_guide("plane_guide", {});
        add_guide("plane_guide", {{"kind", "both"}, {"reach", "3 mm"}});
        add_guide("box_guide", {{"size", "16 mm, 16 mm, 10 mm"}, {"centre", "0 mm, 0 mm, -5 mm"}, {"keep", "outside"}});
        add_guide("box_guide", {{"size", "4 mm, 4 mm, 10 mm"}, {"centre", "0 mm, 0 mm, 4 mm"}});
        add_guide("point_guide", {{"reach", "3 mm"}});
        add_guide("line_guide", {{"reach", "3 mm"}});
        add_guide("path_guide", {{"points", "-10 0 0, 0 2 0, 10 0 0 mm"}, {"reach", "3 mm"}});
        add_guide("detents", {});
        // A blade with its teeth down: y of the blade is −z of the scene.
        static const volume::BoneEditor block = plate(12.0 * mm), thin = plate(1.5 * mm);
        for (const char* type : {"blade_contact", "saw_blade"})
            for (const volume::BoneEditor* bone : {&block, &thin})
                made.push_back({.type = type,
                                .pose = "pose",
                                .stiffness = 800.0,
                                .lever = 20.0 * mm,
                                .tolerance = 1e-5,
                                .depth = bone == &thin ? 3.0 * mm : 1.0 * mm,
                                .turn = 0.1,
                                .rest = rotation_by({-0.5 * std::numbers::pi, 0.0, 0.0}),
                                .set_up =
                                    [=](NodeHarness& n) {
                                        n.feed("bone", bone->current());
                                        if (type == std::string_view("saw_blade")) n.feed("running", false);
                                    },
                                .wired = type == std::string_view("saw_blade")});
        made.push_back({.type = "burr",
                        .pose = "pose",
                        .stiffness = 800.0,
                        .tolerance = 1e-5,
                        .lift = 2.0 * mm,
                        .rest = rotation_by({-0.5 * std::numbers::pi, 0.0, 0.0}),
                        .set_up =
                            [](NodeHarness& n) {
                                n.feed("bone", block.current());
                                n.feed("running", false);
                            },
                        .wired = true});
        for (const char* type : {"point_proxy", "sphere_proxy"})
            for (const char* surface : {"field", "triangles"})
                for (const char* friction : {"0", "0.5"})
                    made.push_back({.type = type,
                                    .pose = "device",
                                    .stiffness = 1000.0,
                                    .tolerance = 1e-3,
                                    .lift = type[0] == 's' ? 2.0 * mm : 0.0,
                                    .set_up = proxied(surface, friction)});
        return made;
    }();
    return all;
}

/// Nodes that turn a pose into a wrench, and why no contact of theirs can be driven along a path.
const std::map<std::string, std::string>& without_contact() {
    static const std::map<std::string, std::string> all{
        {"device_output", "passes a force on"},
        {"device_wrench", "changes the frame of a force"},
        {"force_shaping", "scales a force"},
        {"held_weight", "a weight that the hand carries: gravity and a grip that moves"},
        {"passivity_observer", "watches and damps"},
        {"join_wrench", "puts a force and a torque together"},
        {"dial", "a torque of an angle; tests/nodes/guide drives it"},
        {"viscosity", "drag of a velocity; tests/nodes/guide drives it"},
        {"tumour_margin", "walls that hold who comes through them; tests/nodes/plan drives it on simulated devices"},
        {"vessel", "a rope that pulls; tests/nodes/plan drives it on simulated devices"},
        {"wrench_sum", "adds forces"},
        {"spring", "between two poses, without contact"},
        {"hand_coupling", "a spring between two hands; tests/dsp/coupling drives it"},
    };
    return all;
}

struct Ports final : MemberVisitor {
    void output(std::string_view, Output& port) override { gives_wrench |= port.type == &value_type<Wrench>(); }
    bool gives_wrench = false;
};

}  // namespace

TEST_CASE("every node that gives a wrench is driven on closed paths, or has a reason why it has no contact") {
    std::set<std::string> driven;
    for (const Case& c : cases()) driven.insert(c.type);
    for (const NodeType* type : nodes::catalogue()) {
        Ports ports;
        void* const node = type->create();
        type->visit(node, ports);
        type->destroy(node);
        CAPTURE(type->name);
        CHECK(ports.gives_wrench == (driven.contains(type->name) || without_contact().contains(type->name)));
    }
}

TEST_CASE("no contact node does work on a hand on a closed path beyond half of stiffness times squared steps") {
    for (const Case& c : cases()) {
        double most = 0.0;
        for (const Motion& motion : motions(c.depth, c.turn, c.rest))
            for (const std::int64_t ticks : {1500, 300}) {
                const std::vector<Pose> poses = poses_of(motion, c.lift, ticks);
                const std::string_view type = c.type;
                const auto felt = type == "direct_coupling" ? felt_directly(c, poses) : felt_by(c, poses);
                const Cycle cycle = cycle_of(poses, felt, c);
                CAPTURE(c.type, &c - cases().data(), motion.name, ticks, cycle.work, cycle.bound, cycle.most);
                CHECK(cycle.work <= cycle.bound);
                CHECK(glm::length(felt.front().force) == 0.0);
                CHECK(glm::length(felt.back().force) < 5e-3);
                most = std::max(most, cycle.most);
            }
        CAPTURE(c.type);
        CHECK(most > 0.1);
    }
}

TEST_CASE("pulling a fragment to its fit and taking it away again does no work on the hand beyond sampling") {
    std::vector<bone::Bone> bones =
        library::make_fragments({.voxel = 0.6 * mm, .spacing = 0.8 * mm, .roughness = 0.8 * mm});
    const auto left = std::make_shared<const bone::Bone>(std::move(bones[0]));
    const auto right = std::make_shared<const bone::Bone>(std::move(bones[1]));
    const contact::Pointshell shells[] = {contact::make_pointshell(left->points),
                                          contact::make_pointshell(right->points)};
    const contact::Voxmap maps[] = {contact::make_voxmap(left->distance), contact::make_voxmap(right->distance)};
    coupling::Scene scene;
    scene.count = 2;
    for (std::size_t n = 0; n < 2; ++n) scene.objects[n] = {{&shells[n], &maps[n], nullptr, {}, 1, n + 1}, {}};
    const Case c{.type = "snap_to_fit",
                 .pose = "device",
                 .stiffness = 1000.0,
                 .angular = 1.0,
                 .tolerance = 2e-3,
                 .set_up = [&](NodeHarness& n) {
                     n.asset("moving", right).asset("fixed", left).set("held", "1").set("target", "0");
                     n.feed("scene", scene);
                 }};
    const auto path = [](double s, int n) {
        const double away = 12.0 * mm;
        const double in = eased(s, 0.05, 0.3), out = eased(s, 0.6, 0.85);
        const double x = away * (1.0 - in + out), z = n == 1   ? 10.0 * mm * (eased(s, 0.3, 0.6) - eased(s, 0.85, 1.0))
                                                      : n == 2 ? 1.0 * mm
                                                               : 0.0;
        return Pose{{x, 0.0, z},
                    rotation_by({n == 3 ? 0.1 * (eased(s, 0.3, 0.6) - eased(s, 0.85, 1.0)) : 0.0, 0.0, 0.0})};
    };
    for (int n = 0; n < 4; ++n)
        for (const std::int64_t ticks : {4000, 1000}) {
            const std::vector<Pose> poses = poses_of({"", [&](double s) { return path(s, n); }}, 0.0, ticks);
            const Cycle cycle = cycle_of(poses, felt_by(c, poses), c);
            CAPTURE(n, ticks, cycle.work, cycle.bound, cycle.most);
            CHECK(cycle.work <= cycle.bound);
        }
}
