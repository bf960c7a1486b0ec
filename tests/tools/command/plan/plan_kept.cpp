// SPDX-License-Identifier: Apache-2.0
// Nothing of a plan is lost: not by a run that is killed, not by two programs at once, not by a disk that is full.
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_lock.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/background_run.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

using namespace tactus;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::Run;
using tactus::test::slurp;
using tactus::test::wait_for;

namespace {

namespace fs = std::filesystem;

/// A plan of two fragments that have no files: enough for all that only moves them.
struct Bare {
    Folder folder;
    std::string plan = (folder.path / "case.plan.json").string();

    Bare() {
        plan::CasePlan made;
        made.title = "two";
        for (const char* name : {"a", "b"}) made.fragments.push_back({name, std::string(name) + ".vdb", 1, Vec3(1.0)});
        plan::save_case_plan(made, plan);
    }
    Outcome run(const std::string& verb, const std::string& rest = "") const {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    }
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder.path))
            if (const std::string name = entry.path().filename(); !name.starts_with("std")) names.push_back(name);
        return names;
    }
};

Outcome shell(const Folder& folder, const std::string& script) {
    const fs::path file = folder.write("std.sh", script);
    const std::string command =
        "sh " + file.string() + " >" + (folder.path / "stdout").string() + " 2>" + (folder.path / "stderr").string();
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(folder.path / "stdout"), slurp(folder.path / "stderr")};
}

bool is_one_line(const std::string& text) { return std::ranges::count(text, '\n') == 1; }

}  // namespace

// Costly: a case with all its bones runs, is killed and is opened again.
TEST_CASE("a live case that is killed is on disk as far as it went, and opens with the same bits", "[kernel]") {
    const Folder folder;
    const fs::path out = folder.path / "out", plan = out / "case.plan.json", take = folder.path / "take";
    std::size_t begun = 0, most = 0;
    {
        Run run(folder, "planning-trauma --audio none --out " + out.string() + " --record " + take.string());
        REQUIRE(wait_for([&] { return fs::exists(plan); }));
        begun = plan::load_case_plan(plan).steps.size();
        // Whenever it is looked at, it is whole. Each settled piece is a step.
        REQUIRE(wait_for([&] { return (most = plan::load_case_plan(plan).steps.size()) >= begun + 2; }));
        run.stop(SIGKILL);
    }
    const std::string text = slurp(plan);
    const plan::CasePlan kept = plan::load_case_plan(plan);
    CHECK(kept.steps.size() >= most);
    CHECK(plan::plan_text(kept) == text);
    const json shown = json::parse(folder.tactus("plan show " + plan.string() + " --json").out);
    CHECK(shown["problems"].empty());
    CHECK(shown["steps_done"] == kept.steps.size());
    const plan::PlanState state = plan::state_of(kept);
    for (int n = 0; n < static_cast<int>(kept.fragments.size()); ++n)
        for (int axis = 0; axis < 3; ++axis)
            CHECK(shown["fragments"][static_cast<std::size_t>(n)]["pose"]["position_mm"][static_cast<std::size_t>(axis)]
                      .get<double>() == state.arrangement.pose(n).position[axis] * 1e3);
    // Nobody holds it any more, and what was done goes on from there.
    CHECK(folder.tactus("plan undo " + plan.string()).code == 0);
    const Outcome again = folder.tactus("replay " + take.string());
    INFO(again.out << again.err);
    CHECK(again.code == 0);
}

TEST_CASE("a live case and the same one on a virtual clock leave the same bytes of a plan", "[slow]") {
    const Folder folder;
    const std::string live = (folder.path / "live").string(), log = (folder.path / "log").string(),
                      virt = (folder.path / "virtual").string();
    const Outcome run =
        folder.tactus("run planning-trauma --audio none --seconds 5 --out " + live + " --log " + log + " --json");
    INFO(run.err);
    REQUIRE(run.code == 0);
    REQUIRE(folder.tactus("render planning-trauma --seconds 5 --out " + virt + " --log " + log).code == 0);
    const std::string text = slurp(fs::path(live) / "case.plan.json");
    CHECK(plan::load_case_plan(fs::path(live) / "case.plan.json").steps.size() > 1);
    CHECK(slurp(fs::path(virt) / "case.plan.json") == text);
    CHECK(json::parse(run.out)["notices"].dump().find("saved") == std::string::npos);
}

TEST_CASE("programs that change a plan at the same time do it one after the other, and no step is lost", "[slow]") {
    const Bare bare;
    std::string script;
    for (int n = 0; n < 6; ++n)
        script +=
            tactus::test::command() + " plan move " + bare.plan + " a --pose " + std::to_string(n) + ",0,0,1,0,0,0 &\n";
    shell(bare.folder, script + "wait\n");
    const plan::CasePlan plan = plan::load_case_plan(bare.plan);
    CHECK(plan.steps.size() == 6);
    for (std::size_t n = 0; n < plan.steps.size(); ++n) CHECK(plan.steps[n].before == static_cast<int>(n) - 1);
    CHECK(bare.files() == std::vector<std::string>{"case.plan.json"});
    // A run keeps its plan to itself for as long as it lasts; reading is free.
    const plan::PlanLock lock(bare.plan);
    const Outcome refused = bare.run("undo");
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, Catch::Matchers::ContainsSubstring(
                                "another program (a run or another 'tactus plan') is changing this plan"));
    CHECK(is_one_line(refused.err));
    CHECK(bare.run("show", "--json").code == 0);
    CHECK(bare.run("alternative").code == 0);
}

TEST_CASE("on a full disk a step is refused in one line and the plan stays as it was") {
    const Bare bare;
    REQUIRE(bare.run("move", "a --pose 1,2,3,1,0,0,0").code == 0);
    const std::string before = slurp(bare.plan);
    const std::string verb = tactus::test::command() + " plan move " + bare.plan + " a --pose 4,5,6,1,0,0,0\n";
    const Outcome refused = shell(bare.folder, "trap '' XFSZ\nulimit -f 1\n" + verb);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, Catch::Matchers::ContainsSubstring("case.plan.json: cannot be written"));
    CHECK(is_one_line(refused.err));
    CHECK(slurp(bare.plan) == before);
    CHECK(bare.files() == std::vector<std::string>{"case.plan.json"});
}

TEST_CASE("in a folder that cannot be written to, a step is refused in one line and reading goes on") {
    const Bare bare;
    const std::string before = slurp(bare.plan), tactus = tactus::test::command();
    std::string as_nobody;
    if (::geteuid() == 0) as_nobody = "setpriv --reuid 65534 --clear-groups ";
    else fs::permissions(bare.folder.path, fs::perms::owner_read | fs::perms::owner_exec);
    const std::string show = as_nobody + tactus + " plan show " + bare.plan + " --json\n";
    if (shell(bare.folder, show).code != 0) {
        tactus::test::skip(
            "nobody else may run the command from its folder, so a folder without rights cannot be tried");
        return;
    }
    const Outcome refused =
        shell(bare.folder, as_nobody + tactus + " plan move " + bare.plan + " a --pose 4,5,6,1,0,0,0\n");
    fs::permissions(bare.folder.path, fs::perms::owner_all);
    CHECK(refused.code == 2);
    CHECK_THAT(refused.err, Catch::Matchers::ContainsSubstring("case.plan.json: cannot be changed: Permission denied"));
    CHECK(is_one_line(refused.err));
    CHECK(slurp(bare.plan) == before);
}
