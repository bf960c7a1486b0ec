// SPDX-License-Identifier: Apache-2.0
// Progress of long work on standard error.
#include "tools/command/progress.hpp"
#include "tests/support/catch.hpp"

#include <string>

using namespace tactus::command;

TEST_CASE("progress that is no terminal's has a line for each tenth, after two seconds") {
    int tenths = 0;
    CHECK(progress_line(0.35, "reading", 1.9, tenths).empty());
    CHECK(progress_line(0.35, "reading", 2.1, tenths) == "30 %  reading\n");
    CHECK(progress_line(0.39, "reading", 2.2, tenths).empty());
    CHECK(progress_line(0.7, "", 3.0, tenths) == "70 %\n");
    // Another thread that is behind.
    CHECK(progress_line(0.5, "", 3.0, tenths).empty());
    // The result follows.
    CHECK(progress_line(1.0, "", 9.0, tenths).empty());
    int lines = 0, reached = 0;
    for (int n = 0; n <= 1000; ++n) lines += !progress_line(1e-3 * n, "", 5.0, reached).empty();
    CHECK(lines == 9);
}

TEST_CASE("the bar of progress is as long as the work that is done") {
    CHECK(progress_bar(0.0, "") == "[" + std::string(30, ' ') + "]   0 %");
    CHECK(progress_bar(0.5, "3 of 6 files") ==
          "[" + std::string(15, '#') + std::string(15, ' ') + "]  50 %  3 of 6 files");
    CHECK(progress_bar(1.0, "") == "[" + std::string(30, '#') + "] 100 %");
}
