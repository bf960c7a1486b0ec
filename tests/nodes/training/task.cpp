// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/training/attempt_row.hpp"
#include "graph/node/task_asset.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <cmath>
#include <memory>
#include <numbers>

using namespace tactus;
using test::NodeHarness;

namespace {

/// A cut into the top of a bone at z = 0, towards -z, along x; a ball to spare 8 mm below.
training::Task sample() {
    training::Task task;
    task.title = "top";
    task.cuts[0].point = {0.0, 0.0, 0.0};
    task.cuts[0].depth = 5 * mm;
    task.cuts[0].depth_tolerance = 0.5 * mm;
    task.cuts[0].angle_tolerance = 5 * degree;
    task.limits.force = 6.0;
    task.limits.time = 0.5;
    task.limits.heat = 2.0;
    volume::Grid d{{41, 41, 41}, {-10 * mm, -10 * mm, -18 * mm}, Vec3(0.5 * mm), {}};
    for (int k = 0; k < 41; ++k)
        for (int j = 0; j < 41; ++j)
            for (int i = 0; i < 41; ++i)
                d.values.push_back(
                    static_cast<float>(glm::length(d.position(i, j, k) - Vec3(0.0, 0.0, -8 * mm)) - 1 * mm));
    task.spared.push_back({"nerve", 1 * mm, d});
    return task;
}

/// A blade in the plan, moved aside and deeper, and turned about the feed.
Pose blade(double aside, double depth, double turn) {
    const training::PlannedCut cut = sample().cuts[0];
    const Quat in_plan = glm::quat_cast(cut.axes());
    return {cut.position(0.0, depth, aside), rotation_by(turn * cut.feed) * in_plan};
}

struct Rig {
    NodeHarness node{"task", {.period = flicks_per_second / 1000, .max_frames = 1}};

    Rig() {
        node.asset("task", std::make_shared<const training::Task>(sample()));
        node.feed<double>("removed", 1e-9).feed<double>("heat", 0.0).feed<bool>("contact", true);
        node.feed<Wrench>("force", Wrench{{0.0, 0.0, 2.0}, {}});
    }
    Rig& at(double aside, double depth, double turn = 0.0) {
        node.feed<Pose>("pose", blade(aside, depth, turn));
        return *this;
    }
    Rig& run(int count = 1) {
        node.prepare();
        node.run(count);
        return *this;
    }
    bool flag(const char* output) const { return node.last<bool>(output); }
    double number(const char* output) const { return node.last<double>(output); }
};

}  // namespace

TEST_CASE("the task says where the blade is against the plan") {
    Rig rig;
    rig.at(-0.7 * mm, 2 * mm, 3 * degree).run();
    CHECK(std::abs(rig.number("distance") + 0.7 * mm) < 1e-9);
    CHECK(std::abs(rig.number("angle") - 3 * degree) < 1e-9);
    CHECK(std::abs(rig.number("depth_left") - 3 * mm) < 1e-9);
    CHECK(std::abs(rig.number("clearance") - (8 - 1 - 2 - 0.5) * mm) < 0.2 * mm);
    for (const char* quiet : {"off_plan", "too_deep", "too_near", "over_force", "over_time", "over_heat"})
        CHECK_FALSE(rig.flag(quiet));
}

TEST_CASE("each limit has its flag, and the cue is 1 where one of them is passed") {
    const auto flags_of = [](Rig& rig) {
        std::string set;
        for (const char* name : {"off_plan", "too_deep", "too_near", "over_force", "over_time", "over_heat"})
            if (rig.flag(name)) set += std::string(set.empty() ? "" : " ") + name;
        return set;
    };
    const auto expect = [&](Rig& rig, const std::string& flags) {
        CHECK(flags_of(rig) == flags);
        CHECK((rig.number("cue") == 1.0) == !flags.empty());
    };
    Rig fine, aside, turned, deep, pressed, hot, late;
    expect(fine.at(0.2 * mm, 1 * mm).run(), "");
    CHECK(fine.number("cue") == 0.0);
    expect(aside.at(1.1 * mm, 1 * mm).run(), "off_plan");
    expect(turned.at(0.0, 1 * mm, -6 * degree).run(), "off_plan");
    expect(deep.at(0.0, 6 * mm).run(), "too_deep too_near");
    pressed.node.feed<Wrench>("force", Wrench{{0.0, 5.0, 5.0}, {}});
    expect(pressed.at(0.0, 1 * mm).run(), "over_force");
    hot.node.feed<double>("heat", 2.5);
    hot.at(0.0, 1 * mm).run();
    CHECK(flags_of(hot) == "over_heat");
    late.at(0.0, 1 * mm).run(600);
    CHECK(flags_of(late) == "over_time");
    CHECK(std::abs(late.number("elapsed") - 0.599) < 1e-9);
}

TEST_CASE("a blade in the air is not off the plan") {
    Rig rig;
    rig.node.feed<bool>("contact", false);
    rig.at(20 * mm, -10 * mm, 40 * degree).run(10);
    CHECK_FALSE(rig.flag("off_plan"));
    CHECK(rig.number("cue") == 0.0);
    CHECK(rig.number("elapsed") == 0.0);
}

TEST_CASE("the cue grows from half of a tolerance on") {
    double last = -1.0;
    for (const double aside : {0.4 * mm, 0.6 * mm, 0.8 * mm, 1.0 * mm}) {
        Rig rig;
        rig.at(aside, 1 * mm).run();
        CHECK(rig.number("cue") > last);
        CHECK(std::abs(rig.number("cue") - std::max(0.0, 2.0 * aside / mm - 1.0)) < 1e-6);
        last = std::max(rig.number("cue"), 0.0);
    }
}

TEST_CASE("the record has a row per activation with what the wires had") {
    Rig rig;
    rig.at(0.3 * mm, 1 * mm).run(50);
    REQUIRE(rig.node.host.records.size() == 1);
    const test::MemoryStream& record = *rig.node.host.records.front();
    CHECK(record.format.file == "task.csv");
    CHECK(record.format.type->columns.size() == training::attempt_columns);
    const auto rows = record.values<training::AttemptRow>();
    REQUIRE(rows.size() == 50);
    CHECK(record.gapless);
    const Pose pose = blade(0.3 * mm, 1 * mm, 0.0);
    CHECK(rows.back().px == pose.position.x);
    CHECK(rows.back().py == pose.position.y);
    CHECK(rows.back().qw == pose.orientation.w);
    CHECK(rows.back().fz == 2.0);
    CHECK(rows.back().contact == 1.0);
    CHECK(rows.back().removed == 1e-9);
    CHECK(rows.back().heat == 0.0);
}

TEST_CASE("without wires of contact and heat, force tells the contact and heat is not known") {
    Rig rig;
    rig.node.disconnect("contact").disconnect("heat");
    rig.node.feed<Wrench>("force", [](std::int64_t k) { return Wrench{{0.0, 0.0, k < 10 ? 0.05 : 0.2}, {}}; });
    rig.at(0.0, 1 * mm).run(20);
    const auto rows = rig.node.host.records.front()->values<training::AttemptRow>();
    CHECK(rows[9].contact == 0.0);
    CHECK(rows[10].contact == 1.0);
    CHECK(rows[10].heat < 0.0);
}

TEST_CASE("a lost pose keeps the last one") {
    Rig rig;
    const Pose good = blade(0.5 * mm, 1 * mm, 0.0);
    rig.node.feed<Pose>("pose", [good](std::int64_t k) {
        Pose pose = good;
        if (k >= 5) pose.position.y = std::numeric_limits<double>::quiet_NaN();
        return pose;
    });
    rig.run(10);
    CHECK(std::abs(rig.number("distance") - 0.5 * mm) < 1e-9);
}

TEST_CASE("a scene before the plan cuts along it") {
    NodeHarness node("plan_frame", {.period = flicks_per_second / 1000, .max_frames = 1});
    training::Task task = sample();
    task.cuts[0].point = {10 * mm, -4 * mm, 3 * mm};
    task.cuts[0].feed = {0.0, 1.0, 0.0};
    task.cuts[0].stroke = {0.0, 0.0, 1.0};
    task.cuts[0].normal = glm::cross(task.cuts[0].stroke, task.cuts[0].feed);
    node.asset("task", std::make_shared<const training::Task>(task)).set("clearance", "5 mm");
    // A blade of the workspace, 7 mm down: y of the blade is -z of the device.
    const Quat cuts_down = glm::angleAxis(-90.0 * degree, Vec3(1.0, 0.0, 0.0));
    node.feed<Pose>("pose", Pose{{1 * mm, 2 * mm, -7 * mm}, cuts_down}).feed<Pose>("frame", Pose{});
    node.prepare();
    node.run(1);
    const Pose placed = node.last<Pose>("placed");
    const Vec3 where = task.cuts[0].coordinates(placed.position);
    CHECK(glm::length(where - Vec3(1 * mm, 2 * mm, 2 * mm)) < 1e-9);
    CHECK(glm::length(placed.rotate(Vec3(0.0, 1.0, 0.0)) - task.cuts[0].feed) < 1e-9);
    CHECK(glm::length(placed.rotate(Vec3(1.0, 0.0, 0.0)) - task.cuts[0].stroke) < 1e-9);
}
