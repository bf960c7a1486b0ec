// SPDX-License-Identifier: Apache-2.0
// What ctest must be able to tell tests apart by.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

TEST_CASE("test names contain no semicolon and do not start with a hyphen, a tilde or a bracket") {
    // CMake splits a name at ';', and a part of a name matches no test case. Catch2 reads "-" as an option (a case named
    // "--help shows all" printed the help and passed), "~" as an exclusion and "[" as a tag.
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
