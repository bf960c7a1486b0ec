// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_keeper.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <sys/resource.h>

#include <csignal>

using namespace tactus;

namespace {

plan::CasePlan two() {
    plan::CasePlan plan;
    plan.title = "two";
    for (const char* name : {"a", "b"}) plan.fragments.push_back({name, name, 1, Vec3(1.0)});
    return plan;
}

plan::PlanRecord put(int number, double x) {
    return {number, plan::PlaceFragment{0, {Vec3(x, 0.0, 0.0), {1.0, 0.0, 0.0, 0.0}}}};
}

/// No file may grow beyond so many bytes while this lives: what a full disk does.
struct FullDisk {
    explicit FullDisk(rlim_t bytes) : handler(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before);
        const rlimit less{bytes, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &less);
    }
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before);
        std::signal(SIGXFSZ, handler);
    }
    rlimit before{};
    void (*handler)(int);
};

}  // namespace

TEST_CASE("a kept plan is there from the start, and holds each step once it is saved") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    plan::PlanKeeper keeper(two(), file);
    CHECK(plan::load_case_plan(file).steps.empty());
    for (int n = 0; n < 5; ++n) {
        keeper.add(put(n, 0.1 * (n + 1)), n);
        keeper.save();
        const plan::CasePlan now = plan::load_case_plan(file);
        REQUIRE(now.steps.size() == static_cast<std::size_t>(n) + 1);
        CHECK(now.steps.back().poses[0].position.x == 0.1 * (n + 1));
        CHECK(*now.steps.back().run_second == n);
    }
    // To the step before: what follows is there to be redone.
    keeper.add({5, plan::UndoStep{}}, 9.0);
    keeper.finish();
    CHECK(plan::load_case_plan(file).place().head == 3);
    CHECK(plan::load_case_plan(file).place().tip == 4);
    CHECK(keeper.trouble().empty());
}

TEST_CASE("while the disk is full the last saved plan stays, and all is saved when there is room again") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    plan::PlanKeeper keeper(two(), file);
    keeper.add(put(0, 0.1), 0.0);
    keeper.save();
    const std::string before = file::read_whole_file(file);
    {
        const FullDisk full(100);
        keeper.add(put(1, 0.2), 1.0);
        CHECK_THROWS_WITH(keeper.save(), Catch::Matchers::ContainsSubstring("cannot be written"));
        CHECK(file::read_whole_file(file) == before);
        CHECK_FALSE(std::filesystem::exists(file.string() + ".part"));
    }
    keeper.add(put(2, 0.3), 2.0);
    keeper.save();
    CHECK(plan::load_case_plan(file).steps.size() == 3);
}

TEST_CASE("a plan whose folder is gone at the end is put aside with all of its steps, and the message says where") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    plan::PlanKeeper keeper(two(), file);
    keeper.add(put(0, 0.1), 0.0);
    std::filesystem::remove_all(file.parent_path());
    std::string message;
    try {
        keeper.finish();
    } catch (const Error& error) {
        message = error.message();
    }
    const auto at = message.find("saved to ");
    REQUIRE(at != std::string::npos);
    const std::filesystem::path spare = message.substr(at + 9);
    CHECK(plan::load_case_plan(spare).steps.size() == 1);
    std::filesystem::remove(spare);
    std::filesystem::create_directories(file.parent_path());
}

TEST_CASE("a plan of another run is never overwritten, and one that is continued is") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    {
        plan::PlanKeeper keeper(two(), file);
        keeper.add(put(0, 0.1), 0.0);
        keeper.finish();
    }
    const std::string first = file::read_whole_file(file);
    {
        plan::PlanKeeper keeper(plan::load_case_plan(file), file);
        keeper.add(put(1, 0.2), 0.0);
        keeper.finish();
    }
    CHECK_FALSE(std::filesystem::exists(file.string() + ".1"));
    const std::string second = file::read_whole_file(file);
    {
        // The same case from its beginning: other steps.
        plan::PlanKeeper keeper(two(), file);
        keeper.finish();
    }
    CHECK(file::read_whole_file(file.string() + ".1") == second);
    file::write_whole_file(file, "what is this?");
    {
        plan::PlanKeeper keeper(two(), file);
        keeper.finish();
    }
    CHECK(file::read_whole_file(file.string() + ".2") == "what is this?");
    CHECK(plan::load_case_plan(file).steps.empty());
}

TEST_CASE("a plan with a reconstruction is continued, whose files a run names by their whole paths") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    const auto plan = [](const std::string& where) {
        reconstruction::Reconstruction all;
        all.inputs.planes = {{Vec3(0.0), Vec3(1.0, 0.0, 0.0), {}}, {Vec3(0.03, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), {}}};
        all.donor = {where + "fibula.stl", 1};
        all.jaw = {where + "jaw.stl", 2};
        all.tumour = {where + "tumour.stl", 3};
        plan::PlanStep step;
        step.kind = plan::StepKind::reconstruct;
        step.by = "command";
        step.fragments = {0, 1};
        step.reconstruction = std::make_shared<reconstruction::Reconstruction>(all);
        plan::CasePlan made = two();
        plan::add_step(made, step);
        return made;
    };
    plan::save_case_plan(plan(""), file);
    plan::PlanKeeper(plan("/cases/"), file).finish();
    CHECK_FALSE(std::filesystem::exists(file.string() + ".1"));
}

TEST_CASE("two keepers of one plan: the second is refused until the first has ended") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    {
        const plan::PlanKeeper first(two(), file);
        CHECK_THROWS_WITH(plan::PlanKeeper(two(), file),
                          Catch::Matchers::ContainsSubstring(
                              "another program (a run or another 'tactus plan') is changing this plan"));
    }
    CHECK_NOTHROW(plan::PlanKeeper(two(), file));
    CHECK_THROWS_WITH(plan::PlanKeeper(two(), folder / "none" / "case.plan.json"),
                      Catch::Matchers::ContainsSubstring("cannot be changed"));
}

TEST_CASE("commands that were lost or cannot be applied are reported and the others are kept") {
    const TemporaryFolder folder;
    plan::PlanKeeper keeper(two(), folder / "case.plan.json");
    keeper.add({0, plan::LockFragments{plan::set_of({0}), true}}, 0.1);
    CHECK(keeper.trouble().empty());
    keeper.add({3, plan::LockFragments{plan::set_of({1}), true}}, 0.2);
    CHECK(keeper.trouble() == "2 commands of the run did not reach the plan, before 0.200 s");
    keeper.add({4, plan::LockFragments{plan::set_of({7}), true}}, 0.3);
    keeper.finish();
    CHECK(plan::load_case_plan(folder / "case.plan.json").steps.size() == 2);

    plan::PlanKeeper other(two(), folder / "other.plan.json");
    other.add({0, plan::UndoStep{}}, 1.5);
    CHECK(other.trouble() == "a command of the run at 1.500 s is not in the plan: there is no step to undo");
    other.finish();
}

TEST_CASE("a dropped alternative comes back beside one that was begun since, and the plan can be read") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    plan::PlanKeeper keeper(two(), file);
    std::int64_t number = 0;
    const auto give = [&](const plan::PlanCommand& command) { keeper.add({number++, command}, 0.0); };
    give(plan::GoToAlternative{1});
    give(plan::GoToAlternative{0});
    give(plan::DropAlternative{1});
    give(plan::GoToAlternative{1});
    give(plan::RestoreAlternative{});
    keeper.finish();
    CHECK(keeper.trouble().empty());
    const plan::CasePlan plan = plan::load_case_plan(file);
    REQUIRE(plan.alternatives.size() == 3);
    CHECK(plan.current == 1);
    CHECK(plan.alternatives[2].name == "alternative 2");
}

TEST_CASE("alternatives that were dropped come back one after another and the last one first") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    plan::PlanKeeper keeper(two(), file);
    std::int64_t number = 0;
    const auto give = [&](const plan::PlanCommand& command) { keeper.add({number++, command}, 0.0); };
    for (const int place : {1, 2, 0}) give(plan::GoToAlternative{place});
    give(plan::DropAlternative{1});
    give(plan::DropAlternative{1});
    for (int n = 0; n < 2; ++n) give(plan::RestoreAlternative{});
    keeper.finish();
    CHECK(keeper.trouble().empty());
    const plan::CasePlan plan = plan::load_case_plan(file);
    REQUIRE(plan.alternatives.size() == 3);
    CHECK(plan.alternatives[1].name == "alternative 3");
    CHECK(plan.alternatives[2].name == "alternative 2");
}
