// SPDX-License-Identifier: Apache-2.0
// The case node of a planning session: settling, undoing, joining, hiding.
#include "assets/plan/plan_history.hpp"
#include "dsp/coupling/scene.hpp"
#include "graph/node/notice.hpp"
#include "tests/nodes/plan/broken_case.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>

using namespace tactus;
using namespace tactus::test;

namespace {

Pose home_of(int fragment) {
    Vec3 middle(0.0);
    const auto& points = broken()->bones[static_cast<std::size_t>(fragment)].points;
    for (const contact::SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
    return {middle, {1.0, 0.0, 0.0, 0.0}};
}

/// A scene of the case node, fragment 1 held at `at` (file frame).
struct Session {
    NodeHarness node{"case_scene", servo};
    std::int64_t settle = 1'000'000, release = 1'000'000, undo = 1'000'000, redo = 1'000'000, join = 1'000'000,
                 split = 1'000'000;
    Pose at = beside, fit;
    double target_of = 1.0, partner = 0.0;
    int commands = 0;
    std::vector<const char*> buttons{"lock", "hide", "show"};  ///< that nobody presses

    void run(std::int64_t ticks) {
        const auto press = [this](const char* input, const std::int64_t* when) {
            node.feed<bool>(input, [when](std::int64_t k) { return k >= *when && k < *when + 5; });
        };
        node.asset("plan", broken());
        node.feed<Pose>("moved", at * home_of(1));
        node.feed<double>("which", [this](std::int64_t k) { return k < release + 50 ? 1.0 : -1.0; });
        node.feed<bool>("holding", [this](std::int64_t k) { return k < release; });
        node.feed<Pose>("target", fit * home_of(1));
        node.feed<bool>("fits", true);
        node.feed<double>("partner", partner).feed<double>("target_of", target_of);
        double figure = 0.1;
        for (const char* number : {"score", "margin", "rms", "gap", "penetration", "overlap"})
            node.feed<double>(number, figure), figure *= 2.0;
        for (const char* button : buttons) node.disconnect(button);
        press("settle", &settle);
        press("undo", &undo);
        press("redo", &redo);
        press("join", &join);
        press("split", &split);
        node.prepare();
        node.run(ticks);
    }
    /// A command from outside, as a window gives it.
    void command(const plan::PlanCommand& command) {
        const plan::PlanCommandNumbers numbers = plan::numbers_of(command);
        for (std::size_t n = 0; n < numbers.size(); ++n)
            node.set_value(std::string(plan::plan_command_port[n].name), numbers[n]);
        node.set_value("command_number", static_cast<double>(++commands));
    }
    coupling::Scene scene() const { return node.last<coupling::Scene>("scene"); }
    Pose file_pose(int n) const {
        const coupling::Scene now = scene();
        const coupling::SceneObject& o = now.objects[static_cast<std::size_t>(n)];
        return o.pose * o.body.home.inverse();
    }
    /// What the commands come to that left the node; each must be possible where it was recorded.
    plan::CasePlan plan() const {
        plan::ChangedPlan changed(broken()->plan);
        const auto& stream = *node.host.records[0];
        for (const plan::PlanRecord& record : stream.values<plan::PlanRecord>()) {
            CHECK(changed.apply(record.command) == plan::PlanHistory::Outcome::done);
        }
        return changed.plan();
    }
};

bool same_bits(const Pose& a, const Pose& b) {
    return std::bit_cast<std::array<double, 3>>(a.position) == std::bit_cast<std::array<double, 3>>(b.position) &&
           std::bit_cast<std::array<double, 4>>(a.orientation) == std::bit_cast<std::array<double, 4>>(b.orientation);
}

}  // namespace

TEST_CASE("the port of a plan's commands has the names and kinds by which takes keep them") {
    constexpr std::array names{
        "command",       "command_first",  "command_second", "command_set", "command_switch",      "command_x",
        "command_y",     "command_z",      "command_qw",     "command_qx",  "command_qy",          "command_qz",
        "command_score", "command_margin", "command_rms",    "command_gap", "command_penetration", "command_overlap"};
    REQUIRE(plan::plan_command_port.size() == names.size());
    for (std::size_t n = 0; n < names.size(); ++n) CHECK(plan::plan_command_port[n].name == names[n]);
    const std::pair<double, plan::PlanCommand> kinds[] = {
        {1.0, plan::PlaceFragment{}},      {2.0, plan::SettleFragment{}},   {3.0, plan::JoinFragments{}},
        {4.0, plan::AddFragments{}},       {5.0, plan::SplitFragments{}},   {6.0, plan::DissolveGroup{}},
        {7.0, plan::LockFragments{}},      {8.0, plan::HideFragments{}},    {9.0, plan::UndoStep{}},
        {10.0, plan::RedoStep{}},          {11.0, plan::GoToAlternative{}}, {12.0, plan::DropAlternative{}},
        {13.0, plan::RestoreAlternative{}}};
    for (const auto& [kind, command] : kinds) {
        CAPTURE(kind);
        CHECK(plan::numbers_of(command)[0] == kind);
    }
    NodeHarness node("case_scene", servo);
    for (const char* name : names) CHECK_NOTHROW(node.set_value(name, 0.0));
    CHECK_NOTHROW(node.set_value("command_number", 0.0));
}

TEST_CASE("a settled fragment stands where it fits when it is let go, and the step says so to the bit") {
    Session session;
    session.settle = 100;
    session.release = 200;
    session.fit = {Vec3(0.1, 0.2, -0.1) * mm, rotation_by({0.001, 0.0, 0.002})};
    session.run(400);
    CHECK(off(session.file_pose(1), session.fit) < 1e-12);
    CHECK(session.node.last<double>("steps") == 3.0);
    const plan::CasePlan plan = session.plan();
    REQUIRE(plan.steps.size() == 3);
    CHECK(plan.steps[2].by == "settle");
    const plan::PlanFit& fit = *plan.steps[2].fit;
    CHECK(fit.partner == "left");
    CHECK(std::array{fit.score, fit.margin, fit.rms, fit.gap, fit.penetration, fit.overlap} ==
          std::array{0.1, 0.2, 0.4, 0.8, 1.6, 3.2});
    CHECK(same_bits(session.file_pose(1), plan.steps[2].poses[0]));
    CHECK(session.scene().objects[1].stands);
    CHECK_FALSE(session.scene().objects[2].stands);
}

TEST_CASE("a fragment that is let go without a fit stays where the hand left it") {
    Session session;
    session.release = 200;
    session.run(300);
    CHECK(off(session.file_pose(1), beside) < 1e-9);
    CHECK(session.plan().steps.back().by == "hand");
    CHECK_FALSE(session.scene().objects[1].stands);
}

TEST_CASE("what a run did is undone and redone, and undoing is part of its plan") {
    Session session;
    session.settle = 100;
    session.release = 200;
    session.undo = 300;
    session.run(310);
    CHECK(off(session.file_pose(1)) < 1e-12);
    CHECK(session.node.last<double>("steps") == 2.0);
    plan::CasePlan plan = session.plan();
    CHECK(plan.steps.size() == 3);
    CHECK(plan.place().head == 1);
    CHECK(fit::redone(plan.before(), plan.place()).head == 2);
    Session again;
    again.settle = 100;
    again.release = 200;
    again.undo = 300;
    again.redo = 350;
    again.fit = {Vec3(0.1, 0.2, -0.1) * mm, {1.0, 0.0, 0.0, 0.0}};
    again.run(400);
    CHECK(off(again.file_pose(1), again.fit) < 1e-12);
    CHECK(again.plan().place().head == 2);
}

TEST_CASE("a fragment is not settled where another one would fit") {
    Session session;
    session.settle = 100;
    session.target_of = 0.0;
    session.run(150);
    CHECK_FALSE(session.node.last<bool>("settled"));
    CHECK(off(session.file_pose(1), session.fit) > 1.0 * mm);
}

TEST_CASE("joined fragments are one unit of the scene until they are split") {
    Session session;
    session.join = 100;
    session.run(150);
    CHECK(session.scene().objects[0].unit >= 0);
    CHECK(session.scene().objects[0].unit == session.scene().objects[1].unit);
    CHECK(session.scene().objects[2].unit == -1);
    // The other half is locked, so now nothing moves any more.
    CHECK(off(session.file_pose(0)) == 0.0);
    Session both;
    both.join = 100;
    both.split = 200;
    both.run(300);
    CHECK(both.scene().objects[1].unit == -1);
    // Where it was joined is a step before the join.
    const std::vector<plan::PlanStep> steps = both.plan().steps;
    REQUIRE(steps.size() == 5);
    const auto joined = std::ranges::find(steps, plan::StepKind::group, &plan::PlanStep::kind);
    REQUIRE(joined != steps.end());
    REQUIRE(joined != steps.begin());
    CHECK((joined - 1)->kind == plan::StepKind::place);
}

TEST_CASE("a run undoes and redoes the steps that its plan had before, and goes on from there") {
    Session session;
    session.release = 0;
    session.undo = 100;
    session.redo = 200;
    session.run(150);
    // The last one put the copy away.
    CHECK(off(session.file_pose(2)) < 1e-12);
    CHECK(session.plan().place().head == 0);
    session.node.run(100);
    CHECK(off(session.file_pose(2), broken()->plan.steps[1].poses[0]) < 1e-12);
    CHECK(session.plan().place().head == 1);
    CHECK(session.plan().steps.size() == 2);
}

TEST_CASE("what is hidden leaves the scene until all is shown again, and both are steps") {
    Session session;
    session.release = 50;
    session.node.feed<bool>("hide", [](std::int64_t k) { return k >= 100 && k < 105; });
    session.node.feed<bool>("show", [](std::int64_t k) { return k >= 200 && k < 205; });
    session.buttons = {"lock"};
    session.run(150);
    CHECK(session.scene().objects[1].body.shell == nullptr);
    CHECK(session.scene().objects[0].body.shell != nullptr);
    session.node.run(100);
    CHECK(session.scene().objects[1].body.shell != nullptr);
    const std::vector<plan::PlanStep> steps = session.plan().steps;
    REQUIRE(steps.size() == 5);
    CHECK(steps[3].kind == plan::StepKind::hide);
    CHECK(steps[4].kind == plan::StepKind::show);
    CHECK(steps[4].fragments == std::vector<int>{1});
}

TEST_CASE("a scene that nothing moves keeps its version, and one that the hand moves does not") {
    Session session;
    session.release = 100;
    session.run(300);
    const auto scenes = session.node.values<coupling::Scene>("scene");
    CHECK(scenes[90].version > scenes[50].version);
    CHECK(scenes[299].version == scenes[200].version);
    CHECK(scenes[299].content_hash == coupling::hash_of(scenes[299]));
}

TEST_CASE("a fragment that is grasped and released where it was makes no step") {
    Session session;
    session.at = broken()->plan.steps[1].poses[0];
    REQUIRE(off(session.at, plan::state_of(broken()->plan).arrangement.pose(2)) == 0.0);
    Session still;
    still.at = plan::state_of(broken()->plan).arrangement.pose(1);
    still.release = 200;
    still.run(300);
    CHECK(still.plan().steps.size() == 2);
    CHECK(still.node.last<double>("steps") == 2.0);
}

TEST_CASE("the scene of a run and the plan of its commands have the same poses to the bit also in a group") {
    Session session;
    session.join = 100;
    session.release = 300;
    session.partner = 2.0;
    session.run(250);
    session.node.feed<Pose>("moved", Pose{Vec3(7.0, -3.0, 2.0) * mm, rotation_by({0.3, -0.2, 0.1})} * home_of(1));
    session.node.run(200);
    const plan::PlanState state = plan::state_of(session.plan());
    REQUIRE(state.arrangement.move_together(1, 2));
    CHECK(session.plan().steps.back().fragments == std::vector<int>{1, 2});
    const coupling::Scene scene = session.scene();
    for (std::size_t n = 0; n < 3; ++n)
        CHECK(same_bits(scene.objects[n].pose,
                        state.arrangement.pose(static_cast<int>(n)) * home_of(static_cast<int>(n))));
}

TEST_CASE("undo while a fragment is held does nothing and says why, and so does undo without a step") {
    Session session;
    session.undo = 20;
    session.run(40);
    REQUIRE(off(session.file_pose(1), beside) < 1e-9);
    const auto told = take_notices(session.node.host);
    REQUIRE(told.size() == 1);
    CHECK(told[0].find("while a fragment is held: let it go first") != std::string::npos);

    Session empty;
    empty.release = 0;
    empty.redo = 20;
    empty.run(40);
    const auto nothing = take_notices(empty.node.host);
    REQUIRE(nothing.size() == 1);
    CHECK(nothing[0].find("no step to redo") != std::string::npos);
}

TEST_CASE("commands from outside are each done once and in their order, and the plan has them") {
    Session session;
    session.release = 100;
    session.run(200);
    NodeHarness& node = session.node;
    const Pose place{Vec3(7.0, -3.0, 2.0) * mm, rotation_by({0.3, -0.2, 0.1})};
    session.command(plan::PlaceFragment{2, place});
    node.run(10);
    CHECK(node.last<double>("received") == 1.0);
    CHECK(session.plan().steps.back().poses[0].position == place.position);
    CHECK(off(session.file_pose(2), place) < 1e-15);
    session.command(plan::SettleFragment{1, 0, place, {0.9, 0.2, 1e-4, 2e-4, 3e-4, 4e-5}, plan::FitBasis::hand});
    node.run(10);
    const plan::PlanStep settled = session.plan().steps.back();
    CHECK(settled.fit->verdict == "accepted by hand");
    CHECK(settled.fit->gap == 2e-4);
    session.command(plan::JoinFragments{plan::set_of({1, 2})});
    node.run(300);
    CHECK(session.scene().objects[2].unit == session.scene().objects[1].unit);
    CHECK(session.plan().steps.back().fragments == std::vector<int>{1, 2});
    // Both go together.
    const std::size_t steps = session.plan().steps.size();
    session.command(plan::PlaceFragment{1, Pose{}});
    node.run(300);
    CHECK(session.plan().steps.size() == steps + 1);
    CHECK(session.plan().steps.back().fragments == std::vector<int>{1, 2});
    for (int n = 0; n < 3; ++n)
        CHECK(off(session.file_pose(n), plan::state_of(session.plan()).arrangement.pose(n)) < 1e-12);
}

TEST_CASE("commands from outside that cannot be done are received, and say why") {
    Session session;
    session.release = 0;
    session.run(50);
    NodeHarness& node = session.node;
    const std::size_t steps = session.plan().steps.size();
    const auto said = [&](const plan::PlanCommand& command) {
        take_notices(node.host);
        session.command(command);
        node.run(20);
        CHECK(node.last<double>("received") == session.commands);
        const auto told = take_notices(node.host);
        return told.empty() ? std::string() : told[0];
    };
    using Catch::Matchers::ContainsSubstring;
    CHECK_THAT(said(plan::PlaceFragment{0, beside}), ContainsSubstring("is locked"));
    CHECK_THAT(said(plan::PlaceFragment{9, beside}), ContainsSubstring("not there"));
    CHECK_THAT(said(plan::GoToAlternative{7}), ContainsSubstring("no such alternative"));
    CHECK_THAT(said(plan::DropAlternative{0}), ContainsSubstring("no such alternative"));
    CHECK_THAT(said(plan::RedoStep{}), ContainsSubstring("no step to redo"));
    take_notices(node.host);
    node.set("command", "1").set("command_first", "0.5").set_value("command_number", ++session.commands);
    node.run(20);
    const auto told = take_notices(node.host);
    REQUIRE_FALSE(told.empty());
    CHECK_THAT(told[0], ContainsSubstring("no such kind"));
    CHECK(session.plan().steps.size() == steps);
}

TEST_CASE("a command that a hand may feel asks for its release and is done after it") {
    Session session;
    session.run(100);
    NodeHarness& node = session.node;
    const Pose place{Vec3(0.0, 40.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}};
    // Nothing of the held one: it is done at once.
    session.command(plan::LockFragments{plan::set_of({2}), true});
    node.run(10);
    CHECK(node.last<double>("received") == 1.0);
    CHECK_FALSE(node.last<bool>("release"));
    session.command(plan::PlaceFragment{1, place});
    node.run(20);
    CHECK(node.last<bool>("release"));
    CHECK(node.last<double>("received") == 1.0);
    CHECK(off(session.file_pose(1), beside) < 1e-9);
    // What the port holds meanwhile is of another command.
    node.set("command_x", "1 m");
    session.release = 0;
    node.run(5);
    CHECK_FALSE(node.last<bool>("release"));
    CHECK(node.last<double>("received") == 2.0);
    CHECK(off(session.file_pose(1), place) < 1e-12);
    // Where the hand left it is a step of its own.
    const std::vector<plan::PlanStep> steps = session.plan().steps;
    REQUIRE(steps.size() >= 2);
    REQUIRE(steps[steps.size() - 2].poses.size() == 1);
    CHECK(off(steps[steps.size() - 2].poses[0], beside) < 1e-9);

    // A patch in which nothing releases the hand.
    Session held;
    held.run(100);
    held.command(plan::UndoStep{});
    held.node.run(400);
    CHECK(held.node.last<double>("received") == 1.0);
    const auto told = take_notices(held.node.host);
    REQUIRE_FALSE(told.empty());
    CHECK(told[0].find("wire 'release'") != std::string::npos);
}

TEST_CASE("a run begins an alternative, goes between them, drops one and brings it back, and its plan agrees") {
    Session session;
    session.release = 100;
    session.run(200);
    NodeHarness& node = session.node;
    const Pose first = session.file_pose(1);
    REQUIRE(off(first, beside) < 1e-9);
    const auto go = [&](const plan::PlanCommand& command) {
        session.command(command);
        node.run(20);
    };
    const auto agrees = [&](int current, std::size_t count) {
        const plan::CasePlan plan = session.plan();
        CHECK(plan.current == current);
        CHECK(plan.alternatives.size() == count);
        const plan::PlanState state = plan::state_of(plan);
        for (int n = 0; n < 3; ++n) CHECK(off(session.file_pose(n), state.arrangement.pose(n)) < 1e-9);
        CHECK(node.last<double>("steps") ==
              static_cast<double>(fit::steps_to(plan.before(), plan.place().head).size()));
    };
    agrees(0, 1);
    // A new one begins where the plan is; undo in it leaves the first as it was.
    go(plan::GoToAlternative{1});
    agrees(1, 2);
    CHECK(session.plan().alternatives[1].name == "alternative 2");
    session.undo = 260;
    node.run(100);
    const Pose second = session.file_pose(1);
    REQUIRE(off(second, first) > 1e-4);
    agrees(1, 2);
    go(plan::GoToAlternative{0});
    CHECK(same_bits(session.file_pose(1), first));
    agrees(0, 2);
    go(plan::GoToAlternative{1});
    CHECK(same_bits(session.file_pose(1), second));
    agrees(1, 2);
    go(plan::DropAlternative{0});
    agrees(0, 1);
    go(plan::RestoreAlternative{});
    agrees(0, 2);
    go(plan::GoToAlternative{1});
    CHECK(same_bits(session.file_pose(1), first));
    agrees(1, 2);
    // What is not there is refused, and said.
    take_notices(node.host);
    go(plan::GoToAlternative{7});
    agrees(1, 2);
    go(plan::DropAlternative{1});
    agrees(1, 2);
    const auto told = take_notices(node.host);
    REQUIRE_FALSE(told.empty());
    CHECK(told[0].find("no such alternative") != std::string::npos);
}
