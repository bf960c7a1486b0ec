// SPDX-License-Identifier: Apache-2.0
#include "assets/table/number_table.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/table/deflection_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("a table has columns by name, with commas, semicolons or tabs") {
    for (const char* text : {"# made up\na,b,what\n1,2.5,x\n-3,4e2,y\n", "a;b;what\n1;2.5;x\n\n-3;4e2;y\r\n",
                             "a\tb\twhat\n1\t2.5\tx\n-3\t4e2\ty"}) {
        const table::NumberTable table = table::read_number_table(text, "t.csv");
        REQUIRE(table.rows() == 2);
        CHECK(table.numbers("b") == std::vector<double>{2.5, 400.0});
        CHECK(table.text("what") == std::vector<std::string>{"x", "y"});
    }
}

TEST_CASE("a table that cannot be used says where and why") {
    CHECK_THROWS_WITH(table::read_number_table("", "t.csv"), Catch::Matchers::ContainsSubstring("empty"));
    CHECK_THROWS_WITH(table::read_number_table("a,b\n1,2\n3\n", "t.csv"),
                      Catch::Matchers::ContainsSubstring("t.csv:3"));
    const table::NumberTable table = table::read_number_table("force,b\n1,two\n", "t.csv");
    CHECK_THROWS_WITH(table.numbers("b"),
                      Catch::Matchers::ContainsSubstring("'two'") && Catch::Matchers::ContainsSubstring("t.csv:2"));
    CHECK_THROWS_WITH(table.numbers("forse"), Catch::Matchers::ContainsSubstring("did you mean 'force'"));
    CHECK_THROWS_WITH(table::read_number_table("a\nnan\n", "t").numbers("a"),
                      Catch::Matchers::ContainsSubstring("not a number"));
}

TEST_CASE("deflections come in millimetres, and a calibration is a regression that must be a line") {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, const std::string& text) {
        file::write_whole_file(folder.path / name, text);
        return folder.path / name;
    };
    const control::DeflectionTable foam =
        table::load_deflection_table(write("foam.csv", "force_N,loading_mm,unloading_mm\n0,0,0.5\n2,4,4\n"));
    CHECK(foam.follow(0.0, 1.0) == Approx(2e-3));
    CHECK_THROWS_WITH(table::load_deflection_table(write("bad.csv", "force_N,loading_mm,unloading_mm\n0,0,0\n0,1,1\n")),
                      Catch::Matchers::ContainsSubstring("must rise"));
    const simulate::LineFit fit = table::load_force_calibration(
        write("gauge.csv", "reading,force_N\n100,0\n510,1\n508,1\n920,2\n-310,-1\n101,0\n"));
    CHECK(fit.slope == Approx(1.0 / 410.0).epsilon(2e-3));
    CHECK(fit(100.0) == Approx(0.0).margin(5e-3));
    CHECK_THROWS_WITH(table::load_force_calibration(write("two.csv", "reading,force_N\n1,0\n2,1\n")),
                      Catch::Matchers::ContainsSubstring("three different forces"));
    CHECK_THROWS_WITH(table::load_force_calibration(write("broken.csv", "reading,force_N\n1,0\n900,1\n3,2\n")),
                      Catch::Matchers::ContainsSubstring("do not lie on a line"));
}
