// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_merge.hpp"

#include "assets/plan/plan_files.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <filesystem>

using namespace tactus;

namespace {

plan::CasePlan three() {
    plan::CasePlan plan;
    plan.title = "three";
    for (const char* name : {"a", "b", "c"}) plan.fragments.push_back({name, std::string("/case/") + name, 1, {}});
    return plan;
}

void lock(plan::CasePlan& plan, int fragment) {
    plan::PlanStep step;
    step.kind = plan::StepKind::lock;
    step.by = "command";
    step.fragments = {fragment};
    plan::add_step(plan, step);
}

bool is_locked(const plan::CasePlan& plan, int alternative, int fragment) {
    const int head = plan.alternatives[static_cast<std::size_t>(alternative)].place.head;
    return plan::state_of(plan, head).arrangement.is_locked(fragment);
}

bool is_nothing(const plan::MergedAlternatives& changed) { return changed.added.empty() && changed.forwarded.empty(); }

}  // namespace

TEST_CASE("two versions of a plan combine to all steps of both and the other way is an alternative") {
    plan::CasePlan base = three();
    lock(base, 0);
    plan::CasePlan mine = base, theirs = base;
    lock(mine, 1);
    lock(theirs, 2);
    CHECK(plan::merge(mine, theirs, &base).added == std::vector<std::string>{"main (2)"});
    REQUIRE(mine.steps.size() == 3);
    REQUIRE(mine.alternatives.size() == 2);
    CHECK(mine.current == 0);
    CHECK((is_locked(mine, 0, 1) && !is_locked(mine, 0, 2)));
    CHECK((is_locked(mine, 1, 2) && !is_locked(mine, 1, 1)));
    CHECK((is_locked(mine, 0, 0) && is_locked(mine, 1, 0)));
    // Again: nothing is new, also where the other version does not know of the merge.
    CHECK(is_nothing(plan::merge(mine, theirs, &base)));
    const std::string content = plan::content_of(mine);
    plan::CasePlan again = mine;
    CHECK(is_nothing(plan::merge(again, mine, &base)));
    CHECK(plan::content_of(again) == content);
}

TEST_CASE("the same step on both sides is one step") {
    plan::CasePlan base = three(), mine = base, theirs = base;
    lock(mine, 1);
    lock(theirs, 1);
    CHECK(is_nothing(plan::merge(mine, theirs, &base)));
    CHECK(mine.steps.size() == 1);
}

TEST_CASE("an undo on the other side is an alternative and one that only this side changed is none") {
    plan::CasePlan base = three();
    lock(base, 0);
    plan::CasePlan mine = base, theirs = base;
    lock(mine, 1);
    CHECK(is_nothing(plan::merge(mine, theirs, &base)));
    theirs.place() = {-1, 0};
    CHECK(plan::merge(mine, theirs, &base).added == std::vector<std::string>{"main (2)"});
    CHECK_FALSE(is_locked(mine, 1, 0));
    // Without the ancestor an earlier position is not told from a later one that goes on from it.
    plan::CasePlan restored = base;
    lock(restored, 2);
    CHECK(is_nothing(plan::merge(restored, base, nullptr)));
    plan::CasePlan further = base;
    lock(further, 1);
    CHECK(plan::merge(restored, further, nullptr).added == std::vector<std::string>{"main (2)"});
}

TEST_CASE("an alternative that only the other side has changed moves on and is no alternative of its own") {
    plan::CasePlan base = three();
    lock(base, 0);
    plan::CasePlan mine = base, theirs = base;
    lock(theirs, 1);
    lock(theirs, 2);
    CHECK(plan::merge(mine, theirs, &base).forwarded == std::vector<std::string>{"main"});
    CHECK(mine.alternatives.size() == 1);
    CHECK((is_locked(mine, 0, 1) && is_locked(mine, 0, 2)));
    CHECK(is_nothing(plan::merge(mine, theirs, &base)));
    // Also an undo, which has no step of its own.
    mine = base;
    theirs = base;
    theirs.place() = {-1, 0};
    CHECK(plan::merge(mine, theirs, &base).forwarded == std::vector<std::string>{"main"});
    CHECK_FALSE(is_locked(mine, 0, 0));
    // Without an ancestor, if it goes on from the last step here; an undo here is kept.
    mine = base;
    theirs = base;
    lock(theirs, 1);
    plan::CasePlan undone = base;
    undone.place() = {-1, 0};
    CHECK(plan::merge(mine, theirs, nullptr).forwarded == std::vector<std::string>{"main"});
    CHECK(is_locked(mine, 0, 1));
    CHECK(plan::merge(undone, theirs, nullptr).added == std::vector<std::string>{"main (2)"});
    CHECK_FALSE(is_locked(undone, 0, 0));
}

TEST_CASE("the alternative of an earlier merge moves on with the other side") {
    plan::CasePlan base = three(), mine = base, theirs = base;
    lock(mine, 0);
    lock(theirs, 1);
    plan::merge(mine, theirs, &base);
    lock(theirs, 2);
    CHECK(plan::merge(mine, theirs, &base).forwarded == std::vector<std::string>{"main (2)"});
    REQUIRE(mine.alternatives.size() == 2);
    CHECK((is_locked(mine, 1, 1) && is_locked(mine, 1, 2)));
    CHECK((is_locked(mine, 0, 0) && !is_locked(mine, 0, 1)));
}

TEST_CASE("a merge that would need more alternatives than a run can hold changes nothing and says what to do") {
    plan::CasePlan base = three(), mine = base, theirs = base;
    for (int n = 1; n < 32; ++n) mine.alternatives.push_back({"of mine " + std::to_string(n), {}});
    lock(theirs, 1);
    // Steps of an alternative that moves on need no further one.
    plan::CasePlan full = mine;
    CHECK(plan::merge(full, theirs, &base).forwarded == std::vector<std::string>{"main"});
    lock(mine, 0);
    const std::string before = plan::content_of(mine);
    CHECK_THROWS_WITH(plan::merge(mine, theirs, &base),
                      Catch::Matchers::ContainsSubstring("33 alternatives together, and a plan has at most 32"));
    CHECK(plan::content_of(mine) == before);
}

TEST_CASE("fragments that only the other plan has are added and steps still mean theirs") {
    plan::CasePlan base = three(), mine = base, theirs = base;
    mine.fragments.push_back({"mine", "/case/mine", 7, {}});
    theirs.fragments.push_back({"theirs", "/case/theirs", 8, {}});
    lock(mine, 3);
    lock(theirs, 3);
    plan::merge(mine, theirs, &base);
    REQUIRE(mine.fragments.size() == 5);
    CHECK(mine.fragments[4].name == "theirs");
    CHECK((is_locked(mine, 0, 3) && !is_locked(mine, 0, 4)));
    CHECK((is_locked(mine, 1, 4) && !is_locked(mine, 1, 3)));

    plan::CasePlan another = base;
    another.fragments[0].hash = 2;
    lock(another, 0);
    const std::string before = plan::content_of(mine);
    CHECK_THROWS_WITH(plan::merge(mine, another, &base),
                      Catch::Matchers::ContainsSubstring("different files for the fragment 'a'"));
    CHECK(plan::content_of(mine) == before);
}

TEST_CASE("paths become absolute and are written again as they were or relative to the folder of the plan") {
    plan::CasePlan plan = three();
    plan.fragments[0].file = "bones/a.vdb#left";
    plan.fragments[1].file = "../scan/b.stl";
    plan.fragments[2].file = "/data/c.ply";
    const plan::WrittenPaths written = plan::make_files_absolute(plan, "/home/case");
    CHECK(plan.fragments[0].file == "/home/case/bones/a.vdb#left");
    CHECK(plan.fragments[1].file == "/home/scan/b.stl");
    plan.fragments.push_back({"d", "/home/case/d.vdb", 1, {}});
    plan::CasePlan here = plan, there = plan;
    plan::make_files_relative(here, "/home/case", written);
    CHECK(here.fragments[0].file == "bones/a.vdb#left");
    CHECK(here.fragments[1].file == "../scan/b.stl");
    CHECK(here.fragments[2].file == "/data/c.ply");
    CHECK(here.fragments[3].file == "d.vdb");
    plan::make_files_relative(there, "/home", {});
    CHECK(there.fragments[0].file == "case/bones/a.vdb#left");
    CHECK(plan::content_of(here) == plan::content_of(there));
}
