// SPDX-License-Identifier: Apache-2.0
// An opened plan: saving, what other programs save meanwhile, and what a window that is killed leaves.
#include "tools/window/document/plan_document.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

using namespace tactus;
using namespace tactus::test;
using window::PlanDocument;
namespace fs = std::filesystem;

namespace {

/// A plan whose bones nobody reads.
fs::path write_plan(const Folder& folder) {
    plan::CasePlan plan;
    plan.title = "two";
    for (const char* name : {"a", "b"}) plan.fragments.push_back({name, std::string("bones/") + name, 1, {}});
    const fs::path file = folder.path / "jaw.plan.json";
    plan::save_case_plan(plan, file);
    return file;
}

std::shared_ptr<const plan::CasePlan> locked(plan::CasePlan plan, int fragment) {
    plan::PlanStep step;
    step.kind = plan::StepKind::lock;
    step.by = "hand";
    step.fragments = {fragment};
    plan::add_step(plan, step);
    return std::make_shared<const plan::CasePlan>(std::move(plan));
}

/// Waits for the thread that writes.
bool is_kept(PlanDocument& document, const fs::path& file) {
    for (int n = 0; n < 500 && !fs::exists(file); ++n) {
        CHECK(document.tend().empty());
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    document.tend();
    return fs::exists(file);
}

}  // namespace

TEST_CASE("an opened plan is saved where it was opened, with its paths as they were written") {
    const Folder folder;
    const fs::path file = write_plan(folder);
    const std::string before = slurp(file);
    PlanDocument document(file);
    CHECK(document.is_saved());
    CHECK(document.save().added.empty());
    CHECK(slurp(file) == before);
    document.adopt(locked(document.plan(), 0));
    CHECK_FALSE(document.is_saved());
    CHECK(slurp(file) == before);
    CHECK(document.save().added.empty());
    CHECK(document.is_saved());
    const plan::CasePlan saved = plan::load_case_plan(file);
    CHECK(saved.fragments[0].file == "bones/a");
    REQUIRE(saved.steps.size() == 1);
    CHECK(PlanDocument(file).plan().steps.size() == 1);
}

TEST_CASE("steps that another program has saved meanwhile become an alternative and are in later versions of the run") {
    const Folder folder;
    const fs::path file = write_plan(folder);
    PlanDocument document(file);
    const auto mine = locked(document.plan(), 0);
    document.adopt(mine);
    plan::CasePlan theirs = plan::load_case_plan(file);
    plan::save_case_plan(*locked(theirs, 1), file);
    // Also under its own name that was given once more.
    CHECK(document.save_as(folder.path / "./jaw.plan.json", true).added == std::vector<std::string>{"main (2)"});
    CHECK(document.take_begin_again());
    CHECK_FALSE(document.take_begin_again());
    const plan::CasePlan both = plan::load_case_plan(file);
    CHECK(both.steps.size() == 2);
    CHECK(plan::state_of(both).arrangement.is_locked(0));
    CHECK(plan::state_of(both, both.alternatives[1].place.head).arrangement.is_locked(1));
    // The run knows nothing of them.
    document.adopt(locked(*mine, 1));
    CHECK(document.plan().steps.size() == 3);
    CHECK(document.save().added.empty());
    CHECK(plan::load_case_plan(file).alternatives.size() == 2);
}

TEST_CASE("a file that is no plan any more is not overwritten and the plan can be saved as another file") {
    const Folder folder;
    const fs::path file = write_plan(folder);
    PlanDocument document(file);
    document.adopt(locked(document.plan(), 0));
    file::write_whole_file(file, "notes");
    CHECK_THROWS_AS(document.save(), Error);
    CHECK(slurp(file) == "notes");
    CHECK_THROWS_WITH(document.save_as(file, false), Catch::Matchers::ContainsSubstring("exists already"));
    document.save_as(folder.path / "other/../new.plan.json", false);
    CHECK(document.file() == folder.path / "new.plan.json");
    CHECK(document.is_saved());
    CHECK(plan::load_case_plan(document.file()).fragments[0].file == "bones/a");
}

TEST_CASE("a window that is killed leaves its unsaved steps, which the next one offers, and saving removes them") {
    const Folder folder;
    const fs::path file = write_plan(folder), kept = folder.path / "jaw.plan.unsaved.json";
    // A process of its own: what it holds is free when it is killed.
    const pid_t child = ::fork();
    if (child == 0) {
        PlanDocument document(file);
        document.adopt(locked(document.plan(), 1));
        for (;;) {
            document.tend();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }
    for (int n = 0; n < 1000 && (!fs::exists(kept) || fs::file_size(kept) == 0); ++n)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    CHECK(plan::load_case_plan(file).steps.empty());
    // Another program has added a step since.
    plan::save_case_plan(*locked(plan::load_case_plan(file), 0), file);
    PlanDocument document(file);
    document.find_kept();
    REQUIRE(document.offer() == kept);
    document.restore();
    CHECK_FALSE(document.offer());
    CHECK_FALSE(document.is_saved());
    CHECK(plan::state_of(document.plan()).arrangement.is_locked(1));
    document.save();
    CHECK_FALSE(fs::exists(kept));
    const plan::CasePlan both = plan::load_case_plan(file);
    CHECK(both.steps.size() == 2);
    CHECK(plan::state_of(both).arrangement.is_locked(1));
    PlanDocument next(file);
    next.find_kept();
    CHECK_FALSE(next.offer());
}

TEST_CASE("restoring steps loses none of this window, however young, and saving leaves nothing to offer") {
    const Folder folder;
    const fs::path file = write_plan(folder), first = folder.path / "jaw.plan.unsaved.json";
    {
        PlanDocument document(file);
        document.adopt(locked(document.plan(), 1));
        document.keep();
    }
    PlanDocument document(file);
    document.find_kept();
    REQUIRE(document.offer() == first);
    // In the same picture: nothing of it is in a file yet.
    document.adopt(locked(document.plan(), 0));
    document.restore();
    CHECK(plan::state_of(document.plan()).arrangement.is_locked(1));
    REQUIRE(document.plan().alternatives.size() == 2);
    CHECK(plan::state_of(document.plan(), document.plan().alternatives[1].place.head).arrangement.is_locked(0));
    // A window that is killed now has left all of it.
    std::size_t kept_steps = 0;
    for (const auto& entry : fs::directory_iterator(folder.path))
        if (entry.path().filename().string().find("unsaved") != std::string::npos)
            kept_steps += plan::load_case_plan(entry.path()).steps.size();
    CHECK(kept_steps == 2);
    document.save();
    PlanDocument next(file);
    next.find_kept();
    CHECK_FALSE(next.offer());
    CHECK(next.plan().steps.size() == 2);
}

TEST_CASE("an offer that cannot be read stays until it is answered otherwise") {
    const Folder folder;
    const fs::path file = write_plan(folder), kept = folder.path / "jaw.plan.unsaved.json";
    {
        PlanDocument document(file);
        document.adopt(locked(document.plan(), 1));
        document.keep();
    }
    const std::string whole = slurp(kept);
    file::write_whole_file(kept, "{");
    PlanDocument document(file);
    document.find_kept();
    CHECK_THROWS_AS(document.restore(), Error);
    REQUIRE(document.offer() == kept);
    file::write_whole_file(kept, whole);
    document.restore();
    CHECK(plan::state_of(document.plan()).arrangement.is_locked(1));
}

TEST_CASE("a file that another program alone has changed moves the document on") {
    const Folder folder;
    const fs::path file = write_plan(folder);
    PlanDocument document(file);
    plan::save_case_plan(*locked(plan::load_case_plan(file), 1), file);
    CHECK(document.save().forwarded == std::vector<std::string>{"main"});
    CHECK(document.is_saved());
    CHECK(plan::state_of(document.plan()).arrangement.is_locked(1));
    CHECK(plan::load_case_plan(file).alternatives.size() == 1);
}

TEST_CASE("steps that are not wanted leave no file, and a window that still runs keeps its own") {
    const Folder folder;
    const fs::path file = write_plan(folder), kept = folder.path / "jaw.plan.unsaved.json";
    {
        PlanDocument document(file);
        document.adopt(locked(document.plan(), 1));
        REQUIRE(is_kept(document, kept));
        PlanDocument other(file);
        other.find_kept();
        CHECK_FALSE(other.offer());
        document.drop();
        CHECK_FALSE(document.has_unsaved_steps());
        document.keep();
    }
    CHECK_FALSE(fs::exists(kept));
    {
        PlanDocument document(file);
        document.adopt(locked(document.plan(), 1));
        document.keep();
    }
    CHECK(fs::exists(kept));
}

TEST_CASE("a run begins with the saved file, and with unsaved steps in a file of its own") {
    const Folder folder;
    const fs::path file = write_plan(folder);
    fs::create_directories(folder.path / "run");
    PlanDocument document(file);
    CHECK(document.file_for_run({}) == file);
    document.adopt(locked(document.plan(), 1));
    const fs::path copy = document.file_for_run(folder.path / "run");
    CHECK(copy == folder.path / "run/changed-1.plan.json");
    CHECK(plan::load_case_plan(copy).steps.size() == 1);
    CHECK(plan::load_case_plan(copy).fragments[0].file == (folder.path / "bones/a").string());
    CHECK(plan::load_case_plan(document.file_for_run({})).steps.size() == 1);
    CHECK(plan::load_case_plan(file).steps.empty());
}
