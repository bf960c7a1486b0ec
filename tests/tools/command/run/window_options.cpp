// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

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
