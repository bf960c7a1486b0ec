// SPDX-License-Identifier: Apache-2.0
// What the command says of itself: help by job, version, manual pages, completions; and what it exits with.
#include "tests/support/catch.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <regex>

namespace fs = std::filesystem;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::Run;
using tactus::test::slurp;
using tactus::test::wait_for;

TEST_CASE("the option --help groups verbs by job, and --version says version, build type and compiler") {
    const Folder folder;
    const Outcome help = folder.tactus("--help");
    CHECK(help.code == 0);
    std::size_t at = 0;
    for (const char* job : {"Run and patch:", "\n  run ", "Vibration:", "\n  spectrum ", "Bones:", "\n  import ",
                            "Fractures and plans:", "\n  plan ", "Grippers:", "\n  gripper ",
                            "Displays:", "\n  calibrate ", "This machine:", "\n  devices "}) {
        CAPTURE(job);
        at = help.out.find(job, at);
        REQUIRE(at != std::string::npos);
    }
    CHECK(help.out.find("generate") == std::string::npos);
    const Outcome version = folder.tactus("--version");
    CHECK(version.code == 0);
    CHECK(std::regex_search(version.out,
                            std::regex("^tactus [0-9]+\\.[0-9]+\\.[0-9]+, [A-Za-z]+.*, (GCC|Clang) [0-9]+")));
}

TEST_CASE("lists are versioned rows") {
    const Folder folder;
    for (const char* verb : {"nodes --json", "nodes gain --json"}) {
        const json answer = json::parse(folder.tactus(verb).out);
        CHECK(answer["version"] == 1);
        CHECK(answer["rows"][0].contains("type"));
    }
}

TEST_CASE("what is too stiff exits with 1, what is wrong with 2, a fault that stays with 3") {
    const Folder folder;
    CHECK(folder.tactus("check saw-training").code == 0);
    const Outcome stiff = folder.tactus("check saw-training --set simulated.damping='5 N s/m'");
    CHECK(stiff.code == 1);
    CHECK(stiff.out.find("TOO STIFF") != std::string::npos);
    CHECK(folder.tactus("check saw-training --set nobody.damping='5 N s/m'").code == 2);
    const Outcome fault = folder.tactus(
        "render gripper-wqsm --seconds 1 --set devices.wqsm.fault=unplugged --set "
        "devices.wqsm.fault_at='0.5 s' -o " +
        (folder.path / "out").string());
    CHECK(fault.code == 3);
    CHECK(fault.err.find("at the end of the run") != std::string::npos);
}

TEST_CASE("'trigger' presses a button of a running patch again and again, also after 'set'", "[kernel]") {
    const Folder folder;
    const std::string patch = folder
                                  .write("p.toml",
                                         "wires = [\"undo.pressed -> kept.in\"]\n[nodes.undo]\ntype = \"button\"\n"
                                         "rate = \"1 kHz\"\n[nodes.half]\ntype = \"constant\"\nrate = \"1 kHz\"\n"
                                         "number = 0.5\n[nodes.kept]\ntype = \"record\"\nrate = \"1 kHz\"\n"
                                         "file = \"kept.csv\"\n")
                                  .string();
    ::setenv("XDG_RUNTIME_DIR", folder.path.c_str(), 1);
    {
        Run run(folder, patch + " --audio none --seconds 60 --out " + (folder.path / "out").string());
        REQUIRE(wait_for([&] { return folder.tactus("set half.number=0.25").code == 0; }));
        for (const char* line : {"trigger undo", "trigger undo", "set undo.press=3", "trigger undo undo"}) {
            const Outcome said = folder.tactus(line);
            CAPTURE(line, said.err);
            CHECK(said.code == 0);
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        const Outcome wrong = folder.tactus("trigger half");
        CHECK(wrong.code == 2);
        CHECK(wrong.err.find("this patch has undo") != std::string::npos);
        CHECK(folder.tactus("trigger undu").err.find("did you mean 'undo'?") != std::string::npos);
        CHECK(run.stop(SIGINT) == 0);
    }
    ::unsetenv("XDG_RUNTIME_DIR");
    int presses = 0;
    double before = 0.0;
    std::istringstream rows(slurp(folder.path / "out/kept.csv"));
    for (std::string row; std::getline(rows, row);) {
        const double now = std::strtod(row.substr(row.find(',') + 1).c_str(), nullptr);
        presses += now > 0.5 && before <= 0.5 ? 1 : 0;
        before = now;
    }
    CHECK(presses == 5);
}

TEST_CASE("manual pages and completions name every verb and its options") {
    const Folder folder;
    const std::string out = folder.path.string();
    for (const char* what : {"man", "bash", "zsh", "fish"})
        CHECK(folder.tactus("generate " + (what + (" " + out))).code == 0);
    CHECK(folder.tactus("generate poem " + out).code == 2);
    for (const char* page : {"tactus.1", "tactus-render.1", "tactus-plan.1", "tactus-plan-move.1"}) {
        CAPTURE(page);
        const std::string text = slurp(folder.path / page);
        CHECK(text.starts_with(".TH tactus"));
        CHECK(text.find(".SH EXIT STATUS") != std::string::npos);
    }
    CHECK(slurp(folder.path / "tactus-render.1").find("\\fB\\-\\-jobs\\fR") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.path / "tactus-generate.1"));
    const auto completed = [&](const std::string& line, int word) {
        const std::string script = "source " + out + "/tactus.bash; COMP_WORDS=(" + line +
                                   "); COMP_CWORD=" + std::to_string(word) + "; _tactus; echo \"${COMPREPLY[*]}\"";
        folder.write("try.sh", script);
        const int status = std::system(("bash " + out + "/try.sh >" + out + "/said").c_str());
        CHECK(status == 0);
        return slurp(folder.path / "said");
    };
    CHECK(completed("tactus spec", 1) == "spectrum\n");
    CHECK(completed("tactus render p.toml --job", 3) == "--jobs\n");
    CHECK(completed("tactus plan mo", 2) == "move\n");
    CHECK(completed("tactus snap --mode b", 3) == "baseline\n");
    CHECK(completed("tactus --memory render spec", 3) == "spectrum\n");
    const std::string snap = slurp(folder.path / "tactus-snap.1");
    CHECK(snap.find("(default: extended)") != std::string::npos);
    CHECK(slurp(folder.path / "_tactus").find("('snap --mode') values=(extended global baseline) ;;") !=
          std::string::npos);
    for (const char* file : {"_tactus", "tactus.fish"}) {
        const std::string text = slurp(folder.path / file);
        for (const char* word : {"spectrum", "gripper", "band", "jobs"}) CHECK(text.find(word) != std::string::npos);
        CHECK(text.find("generate poem") == std::string::npos);
    }
}
