// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <cstdlib>
#include <filesystem>

using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("a scan for a run without a window is refused, and nothing is written") {
    const Folder folder;
    const Outcome run = folder.tactus("run planning-trauma --scan head.nrrd --seconds 0.1 --out out");
    CHECK(run.code == 2);
    CHECK_THAT(run.err, ContainsSubstring("--scan") && ContainsSubstring("--view"));
    CHECK_FALSE(std::filesystem::exists(folder.path / "out"));
}

TEST_CASE("the command alone says what to try, and without a display 'try' says what else works") {
    const Folder folder;
    const Outcome alone = folder.tactus("");
    CHECK(alone.code == 0);
    for (const char* step : {"tactus try", "tactus view", "tactus render saw-training", "tactus new", "tactus --help"})
        CHECK_THAT(alone.out, ContainsSubstring(step));

    const char* kept[] = {std::getenv("DISPLAY"), std::getenv("WAYLAND_DISPLAY")};
    const std::string displays[] = {kept[0] ? kept[0] : "", kept[1] ? kept[1] : ""};
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
    const Outcome blind = folder.tactus("try --out " + (folder.path / "out").string());
    if (kept[0]) ::setenv("DISPLAY", displays[0].c_str(), 1);
    if (kept[1]) ::setenv("WAYLAND_DISPLAY", displays[1].c_str(), 1);
    CHECK(blind.code == 2);
    CHECK_THAT(blind.err, ContainsSubstring("no display") && ContainsSubstring("tactus render saw-training"));
    CHECK_FALSE(std::filesystem::exists(folder.path / "out"));
}
