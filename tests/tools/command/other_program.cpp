// SPDX-License-Identifier: Apache-2.0
// What the command does not have itself, it gets from the programs beside it.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace tactus::test;

TEST_CASE("a command without the other programs runs patches, and names the one that a verb or a window needs") {
    const Folder folder;
    folder.write("touch.toml", touch);
    const auto alone = folder.path / "tactus";
    std::filesystem::copy_file(command(), alone);
    const auto said = folder.path / "said";
    const auto code_of = [&](const std::string& words) {
        const std::string line = "cd " + folder.path.string() + " && ./tactus " + words + " >said 2>&1";
        return WEXITSTATUS(std::system(line.c_str()));
    };
    CHECK(code_of("render touch.toml --seconds 0.01 --out here") == 0);
    for (const char* words : {"plan show case.plan.json", "run touch.toml --view", "--help", ""}) {
        INFO(words);
        CHECK(code_of(words) == 2);
        const std::string text = slurp(said);
        CHECK(text.find("--target tactus-full") != std::string::npos);
    }
    CHECK(code_of("--memory \"1 GB\" render touch.toml --seconds 0.01 --out there") == 0);
    CHECK(code_of("run touch.toml --no-such-option") == 2);
    CHECK(slurp(said).find("tactus-full") == std::string::npos);
}

TEST_CASE("a take of one program replays in another one of the same build, without a word about the build",
          "[kernel]") {
    const Folder folder;
    folder.write("touch.toml", touch);
    const std::string full = (std::filesystem::path(command()).parent_path() / "tactus-full").string();
    const std::string in_folder = "cd " + folder.path.string() + " && ";
    REQUIRE(std::system((in_folder + full + " run touch.toml --seconds 0.05 --record take --out out >/dev/null 2>&1")
                            .c_str()) == 0);
    const Outcome replay = folder.tactus("replay " + (folder.path / "take").string());
    CHECK(replay.code == 0);
    CHECK(replay.err.find("another build") == std::string::npos);
}
