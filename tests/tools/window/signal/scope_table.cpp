// SPDX-License-Identifier: Apache-2.0
// The files of a scope hold what it shows, to the last digit.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/signal/table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace tactus;
using namespace tactus::window;

namespace {

Trace force() { return {{0.5, 0.501, 0.502}, {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, {"fx", "tx"}, 1e-3}; }

}  // namespace

TEST_CASE("a table of a scope spells the unit of every column") {
    const test::Folder folder;
    const Trace trace = force();
    const TableTrace whole{&trace, {"N", "N m"}};
    write_csv(std::span(&whole, 1), {0.5005, 0.6}, folder.path / "force.csv");
    CHECK(test::slurp(folder.path / "force.csv") == "time s,fx N,tx N m\n0.501000000,2,5\n0.502000000,3,6\n");
    CHECK(column_units(value::pose, "m").size() == value::pose.columns.size());
    CHECK(column_units(value::wrench, "N").size() == value::wrench.columns.size());
    CHECK(column_units(value::twist, "").at(3) == "rad/s");
    CHECK(column_units(value::number, "K") == std::vector<std::string>{"K"});
}

TEST_CASE("a table tells samples of 48 kHz apart after 1000 s, and its numbers are the bits that were there") {
    const test::Folder folder;
    const double first = 1234.0, second = 1234.0 + 1.0 / 48000.0, odd = 0.1 + 0.2;
    const Trace trace{{first, second}, {{odd, 1.0}}, {"value"}, 1.0 / 48000.0};
    const TableTrace whole{&trace, {""}};
    write_csv(std::span(&whole, 1), {1000.0, 2000.0}, folder.path / "long.csv");
    CHECK(test::slurp(folder.path / "long.csv") ==
          "time s,value\n1234.000000000,0.30000000000000004\n1234.000020833,1\n");
}

TEST_CASE("signals over a wave are columns of its table, empty at times that they do not have") {
    const test::Folder folder;
    const Trace trace = force(), slow{{0.5, 0.502}, {{7.0, 9.0}}, {"value"}, 2e-3};
    const TableTrace both[] = {{&trace, {"N", "N m"}}, {&slow, {"V"}, "level.value"}};
    write_csv(both, {0.0, 1.0}, folder.path / "both.csv");
    CHECK(test::slurp(folder.path / "both.csv") ==
          "time s,fx N,tx N m,level.value value V\n0.500000000,1,4,7\n0.501000000,2,5,\n0.502000000,3,6,9\n");
}

TEST_CASE("tables of a spectrum, a histogram, pairs and a waterfall hold what is shown with its units") {
    const test::Folder folder;
    const auto file = folder.path / "shown.csv";
    Plot spectrum;
    spectrum.x = {10.0, 100.0};
    spectrum.level_unit = "dB re (V)²/Hz";
    spectrum.curves = {{"value", 0, {{10.0, -3.0}, {20.0, -6.5}}}, {"other", 0, {{20.0, 1.0}}}};
    write_spectrum_csv(spectrum, file);
    CHECK(test::slurp(file) == "frequency Hz,value dB re (V)²/Hz,other dB re (V)²/Hz\n10,-3,\n20,-6.5,1\n");

    const Trace even{{0.0, 0.1, 0.2, 0.3}, {{0.0, 1.0, 2.0, 60.0}}, {"value"}, 0.1};
    write_histogram_csv(histogram_plot(even, 0, {1.0, "V", 1}, 0.3, 0.3), file);
    CHECK(test::slurp(file).starts_with("from V,to V,share %\n0,1,25\n1,2,25\n"));
    write_pairs_csv(xy_plot(even, 0, {1.0, "V", 1}, even, 0, {1e3, "mm", 1}, 0.3, 0.3), file);
    CHECK(test::slurp(file) == "x V,y mm\n0,0\n1,1000\n2,2000\n60,60000\n");

    Plot waterfall;
    waterfall.is_logarithmic = true;
    waterfall.x = {10.0, 1000.0};
    waterfall.level_unit = "dB re (V)²/Hz";
    waterfall.waterfall = Waterfall{{0.0, 2.0}, waterfall.x, 2, 1, {-3.0, -240.0}, {100.0, 0.0}};
    write_waterfall_csv(waterfall, file);
    CHECK(test::slurp(file) == "time s,100 Hz in dB re (V)²/Hz\n0.500000000,-3\n1.500000000,\n");
}
