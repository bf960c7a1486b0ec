// SPDX-License-Identifier: Apache-2.0
// Every case of every test program is a test of ctest: a tag without a label in tests/CMakeLists.txt would hide it.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace tactus::test;

/// Lines that a command prints, without what stands before `after` in each.
std::set<std::string> printed_lines(const Folder& folder, const std::string& line, const std::string& after) {
    // Its code is of no use: Catch2 2 returns the number of cases.
    (void)std::system(fmt::format("{} > '{}' 2>&1", line, (folder.path / "lines").string()).c_str());
    std::istringstream lines(slurp(folder.path / "lines"));
    std::set<std::string> all;
    for (std::string one; std::getline(lines, one);)
        if (const auto at = one.find(after); at != std::string::npos) all.insert(one.substr(at + after.size()));
    return all;
}

}  // namespace

TEST_CASE("every case of every test program is in a tier") {
    const fs::path build = fs::path(command()).parent_path();
    const Folder folder;
    const std::set<std::string> tiers =
        printed_lines(folder, fmt::format("ctest --test-dir '{}' -N -L '.'", build.string()), ": ");
    int programs = 0, cases = 0;
    for (const auto& entry : fs::directory_iterator(build / "tests")) {
        const std::string program = entry.path().filename().string();
        if (!program.starts_with("test_") || !entry.is_regular_file() ||
            (entry.status().permissions() & fs::perms::owner_exec) == fs::perms::none)
            continue;
        ++programs;
        constexpr const char* list =
            CATCH_VERSION_MAJOR > 2 ? "--list-tests --verbosity quiet" : "--list-test-names-only";
        for (const std::string& name :
             printed_lines(folder, fmt::format("'{}' '~[.]' {}", entry.path().string(), list), "")) {
            if (name.empty()) continue;
            ++cases;
            CAPTURE(program, name);
            CHECK(tiers.contains(fmt::format("{}:{}", program.substr(5), name)));
        }
    }
    CHECK(programs > 0);
    CHECK(cases > 100);
}
