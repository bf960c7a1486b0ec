// SPDX-License-Identifier: Apache-2.0
// What ctest must be able to tell tests apart by.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

TEST_CASE("names of test cases hold no semicolon, and begin with no letter that has a meaning for Catch2") {
    // CMake cuts a name at a semicolon: a half of it names no test case, and passed. "-" begins an option ("--help shows all"
    // printed the help and passed), "~" excludes a case, "[" begins a tag.
    static const std::regex name("\nTEST_CASE\\(\\s*((?:\"(?:[^\"\\\\]|\\\\.)*\"\\s*)+)");
    int names = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(tactus::test::source_folder() / "tests")) {
        if (entry.path().extension() != ".cpp") continue;
        std::ifstream stream(entry.path());
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at, ++names) {
            CAPTURE(entry.path().string(), (*at)[1].str());
            CHECK((*at)[1].str().find(';') == std::string::npos);
            CHECK((*at)[1].str().find_first_of("-~[") != 1);  // after the quotation mark
        }
    }
    CHECK(names > 1000);
}
