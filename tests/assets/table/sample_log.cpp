// SPDX-License-Identifier: Apache-2.0
#include "assets/table/sample_log.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

namespace {

table::SampleLog read(std::string_view text, table::LogSelection selection = {}) {
    return table::read_sample_log(text, "l.csv", selection);
}

} // namespace

TEST_CASE(
    "a log's time column and axes are found by their names, milliseconds "
    "by the ending") {
    const table::SampleLog log = read(
        "# logger "
        "2\ntimestamp_ms,global_ms,accel_x,accel_y,temp_"
        "c\n3,100,1,-2,24\n9,106,3,4.5,24\n");
    CHECK(log.times == std::vector{3.0 * 1e-3, 9.0 * 1e-3});
    CHECK(log.names == std::vector<std::string>{"accel_x", "accel_y"});
    CHECK(log.columns[1] == std::vector{-2.0, 4.5});
    CHECK(log.time_name == "timestamp_ms");
}

TEST_CASE(
    "columns are chosen by name or number, and semicolons with decimal "
    "commas and tabs are read") {
    table::LogSelection selection;
    selection.columns = {"temp", "2"};
    const table::SampleLog log = read("t_s;a;temp\r\n0,5;1;20,25\r\n1,0;2;20,5\r\n", selection);
    CHECK(log.times == std::vector{0.5, 1.0});
    CHECK(log.columns[0] == std::vector{20.25, 20.5});
    CHECK(log.columns[1] == std::vector{1.0, 2.0});
    CHECK(read("0\t5\n1\t6\n").columns[0] == std::vector{5.0, 6.0});
    selection.columns = {"a"};
    selection.time_unit = "us";
    CHECK(read("t,a\n1000000,7\n2000000,8\n", selection).times == std::vector{1.0, 2.0});
}

TEST_CASE("a number that may have a thousands separator is refused, one that cannot is read") {
    using Catch::Matchers::ContainsSubstring;
    CHECK_THROWS_WITH(read("t,a\n0,\"1,234\"\n1,\"2,345\"\n"), ContainsSubstring("'1,234' may be 1234 or 1.234"));
    CHECK(read("t_s,a\n\"0,5\",\"1,25\"\n\"1,0\",\"2,5\"\n").columns[0] == std::vector{1.25, 2.5});
    CHECK_THROWS_WITH(read("t;a\n0;1,234\n1;2,345\n"),
                      ContainsSubstring("l.csv:2:1") && ContainsSubstring("may be 1234 or 1.234"));
    CHECK_THROWS_WITH(read("t;a\n0;1,234.5\n"), ContainsSubstring("thousands separators"));
    CHECK_THROWS_WITH(read("t;a\n0;1.234.567\n"), ContainsSubstring("thousands separators"));
    CHECK_THROWS_WITH(read("t;a\n0,5;1.234\n"), ContainsSubstring("some numbers have a decimal comma"));
    CHECK(read("t;a\n0,5;1,234\n1,5;2,345\n").columns[0] == std::vector{1.234, 2.345});
    CHECK(read("t\ta\n0,5\t1,25\n").columns[0] == std::vector{1.25});
    CHECK(read("t;a\n0;1.234\n1;2.345\n").columns[0] == std::vector{1.234, 2.345});
    CHECK(read("t,a\n0,\"1.5\"\n").columns[0] == std::vector{1.5});
}

TEST_CASE("rows without a number are counted as lost, a half last line too") {
    const table::SampleLog log = read("t_s,a\n0,1\n1,\n2,nan\n3,4\n4");
    CHECK(log.times == std::vector{0.0, 3.0});
    CHECK(log.lost_rows == 3);
}

TEST_CASE("what is no log is refused with its place") {
    CHECK_THROWS_WITH(read(""), Catch::Matchers::ContainsSubstring("empty"));
    CHECK_THROWS_WITH(read("a,b\n1,2\n"), Catch::Matchers::ContainsSubstring("l.csv:1:1") &&
                                              Catch::Matchers::ContainsSubstring("--time-column"));
    CHECK_THROWS_WITH(read("t,a\n0,1\n1,x2\n"),
                      Catch::Matchers::ContainsSubstring("l.csv:3:2") && Catch::Matchers::ContainsSubstring("'x2'"));
    CHECK_THROWS_WITH(read("t,a\n5,1\n4,2\n"), Catch::Matchers::ContainsSubstring("backwards"));
    CHECK_THROWS_WITH(read("t,a,b\n0,1,2\n"), Catch::Matchers::ContainsSubstring("--column"));
    CHECK_THROWS_WITH(read("t,a\n0,1\n1\n2,3\n"), Catch::Matchers::ContainsSubstring("l.csv:3"));
    CHECK_THROWS_WITH(read("just words\nno numbers\n"), Catch::Matchers::ContainsSubstring("no line holds numbers"));
    CHECK_THROWS_WITH(read("a\n1\n2\n"), Catch::Matchers::ContainsSubstring("only one column") &&
                                             Catch::Matchers::ContainsSubstring("--sample-rate"));
    table::LogSelection selection;
    selection.columns = {"accel_q"};
    CHECK_THROWS_WITH(read("t,accel_x,b\n0,1,2\n", selection),
                      Catch::Matchers::ContainsSubstring("did you mean 'accel_x'"));
    CHECK_THROWS_WITH(table::load_sample_log("/nowhere/x.csv", {}), Catch::Matchers::ContainsSubstring("no such file"));
}
