// SPDX-License-Identifier: Apache-2.0
// The benchmarks are a program beside the command.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

TEST_CASE("'bench' hands everything on to the program beside the command", "[slow]") {
    const Folder folder;
    const Outcome help = folder.tactus("bench --help");
    CHECK(help.code == 0);
    CHECK(help.out.find("tactus bench") != std::string::npos);
    for (const char* verb : {"engine", "contact", "view", "scrub", "snap"}) {
        CHECK(help.out.find(verb) != std::string::npos);
        // Names that both programs know reach the other one.
        CHECK(folder.tactus(std::string("bench ") + verb + " --help").code == 0);
    }
    CHECK(folder.tactus("bench snap --help").out.find("--seeds") != std::string::npos);
    CHECK(folder.tactus("bench").code == 2);
    CHECK(folder.tactus("bench engine --rounds 0").code == 2);
    const Outcome wrong = folder.tactus("bench snap --case nothing");
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("there is no case 'nothing'") != std::string::npos);
}

TEST_CASE("'bench' says how to get the program when it is missing") {
    const Folder folder;
    const auto alone = folder.path / "tactus";
    std::filesystem::copy_file(tactus::test::command(), alone);
    const auto said = folder.path / "said";
    const int status = std::system((alone.string() + " bench engine 2>" + said.string()).c_str());
    CHECK(WEXITSTATUS(status) == 2);
    CHECK(slurp(said).find("--target tactus-bench") != std::string::npos);
}
