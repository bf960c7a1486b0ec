// SPDX-License-Identifier: Apache-2.0
#include "assets/table/sample_log.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <cstdint>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

table::SampleLog read(std::string_view text, table::LogSelection selection = {}) {
    return table::read_sample_log(text, "l.csv", selection);
}

} // namespace

TEST_CASE("long times with an exponent keep their digits") {
    std::string micros = "time_us,a\n", seconds = "time,a\n", nanos = "timestamp,a\n", commas = "time_us;a\n";
    for (int i = 0; i < 50; ++i) {
        micros += fmt::format("{:.12e},{}\n", 1.999e9 + 1000.0 * i, i);
        seconds += fmt::format("{:.12e},{}\n", 1.7e9 + 0.005 * i, i);
        nanos += fmt::format("1.{:018d}e+18,{}\n", 700000000000000001 + std::int64_t{1000001} * i, i);
        commas += fmt::format("1,999{:03d}e+09;{}\n", i, i);
    }
    const auto step = [](const table::SampleLog& log) { return (log.times.back() - log.times.front()) / 49.0; };
    CHECK(step(table::read_sample_log(micros, "l.csv", {})) == Approx(1e-3));
    const table::SampleLog dates = table::read_sample_log(seconds, "l.csv", {});
    CHECK(step(dates) == Approx(5e-3));
    CHECK_THAT(dates.form.time, ContainsSubstring("dates in s"));
    const table::SampleLog phone = table::read_sample_log(nanos, "l.csv", {});
    for (std::size_t i = 1; i < 50; ++i)
        CHECK(phone.times[i] - phone.times[0] == Approx(1.000001e-3 * static_cast<double>(i)).epsilon(1e-9));
    CHECK(step(table::read_sample_log(commas, "l.csv", {})) == Approx(1e-3));
}

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

TEST_CASE("a column whose name contains commas is named whole, without its unit, quoted in a list, or by number") {
    const std::string text =
        "\"time, s\",\"acc, x (g)\",\"acc, y (g)\",\"unit=a, of\",acc\n0,1,2,7,3\n1,4,5,8,6\n2,4,5,7,6\n";
    const auto values = [&](const std::vector<std::string>& columns, const std::string& where = "",
                            const std::string& time = "time, s") {
        table::LogSelection selection;
        selection.columns = columns;
        selection.time_column = time;
        selection.time_unit = "s";
        selection.where = where;
        const table::SampleLog log = read(text, selection);
        std::string all;
        for (const std::string& name : log.names) all += name + "|";
        return all;
    };
    CHECK(values({"acc, x (g)"}) == "acc, x|");
    CHECK(values({"acc, x"}) == "acc, x|");
    CHECK(values({"acc, x (g)", "acc"}) == "acc, x|acc|");
    CHECK(values({"\"acc, x (g)\",acc"}) == "acc, x|acc|");
    CHECK(values({"acc,\"acc, y (g)\""}) == "acc|acc, y|");
    CHECK(values({"acc, \"acc, y\", 2"}) == "acc|acc, y|acc, x|");
    CHECK(values({"2,3"}) == "acc, x|acc, y|");
    CHECK(values({"acc"}, "unit=a, of=7") == "acc|");
    CHECK(values({"acc"}, "\"unit=a, of\"=7") == "acc|");
    CHECK(values({"acc"}, "", "\"time, s\"") == "acc|");
    CHECK(values({"acc"}, "", "1") == "acc|");
    table::LogSelection selection;
    selection.where = "unit=a, of=7";
    selection.time_column = "time, s", selection.time_unit = "s", selection.columns = {"acc"};
    CHECK(read(text, selection).times == std::vector{0.0, 2.0});
    using Catch::Matchers::ContainsSubstring;
    CHECK_THROWS_WITH(values({"acc, z"}), ContainsSubstring("there is no column 'z'") &&
                                              ContainsSubstring("there are \"time, s\", \"acc, x (g)\", \"acc, y"));
    CHECK_THROWS_WITH(values({"acc, x,acc"}), ContainsSubstring("there is no column 'x'"));
    CHECK_THROWS_WITH(values({"acc,"}), ContainsSubstring("there is no column ''"));
    CHECK_THROWS_WITH(values({"acc"}, "", "1,2"), ContainsSubstring("--time-column names 2 columns"));
}

TEST_CASE("of a list for two files each takes its own name, and a name that both have is one name") {
    using Catch::Matchers::ContainsSubstring;
    table::LogSelection selection;
    selection.columns = {"a,b"};
    selection.list_entry = 0;
    CHECK(read("t_s,a,b\n0,1,2\n1,3,4\n", selection).names.front() == "a");
    selection.list_entry = 1;
    CHECK(read("t_s,a,b\n0,1,2\n1,3,4\n", selection).names.front() == "b");
    CHECK(read("t_s,\"a,b\"\n0,1\n1,3\n", selection).names.front() == "a,b");
    selection.columns = {"a"};
    CHECK(read("t_s,a,b\n0,1,2\n1,3,4\n", selection).names.front() == "a");
    CHECK_THROWS_WITH(read("t_s,c,d\n0,1,2\n", selection),
                      ContainsSubstring("l.csv:1:1: there is no column 'a'") && ContainsSubstring("REFERENCE,OUTPUT"));
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
