// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/units.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <numbers>

using namespace tactus;

TEST_CASE("a quantity is stored in SI whatever unit it was written in") {
    CHECK(parse_as("0.8 N/mm", "N/m") == Approx(800.0));
    CHECK(parse_as("1 kHz", "Hz") == Approx(1000.0));
    CHECK(parse_as("30 cm", "m") == Approx(0.3));
    CHECK(parse_as("-20 deg", "rad") == Approx(-20.0 * std::numbers::pi / 180.0));
    CHECK(parse_as("5 N s/m", "N s/m") == Approx(5.0));
    CHECK(parse_as("9.81 m/s²", "m/s^2") == Approx(9.81));
    CHECK(parse_as("1750 mg/cm^3", "kg/m^3") == Approx(1750.0));
    CHECK(parse_as("40 mm/min", "m/s") == Approx(0.04 / 60.0));
    CHECK(parse_as("3 V", "V") == Approx(3.0));
    CHECK(parse_as("128 µH", "H") == Approx(128e-6));
    CHECK(parse_as("25 %", "") == Approx(0.25));
    CHECK(parse_as("700 HU", "HU") == Approx(700.0));
    CHECK(parse_as("2 kW/m^2/K", "W/m^2/K") == Approx(2000.0));
    CHECK(parse_as("-17 K", "K") == Approx(-17.0));
}

TEST_CASE("dimensions do not mix") {
    CHECK_THROWS_AS(parse_as("1 Hz", "rad/s"), Error);
    CHECK_THROWS_AS(parse_as("1 N", "N/m"), Error);
    CHECK_THROWS_WITH(parse_as("5", "N/m"), Catch::Matchers::ContainsSubstring("needs a unit"));
    CHECK_THROWS_AS(parse_as("5 mm", ""), Error);
}

TEST_CASE("malformed quantities are refused") {
    for (const char* text :
         {"", "N", "1 N/", "1 N//m", "1 foo", "nan N", "inf m", "1e400 m", "1 m^", "1 m^99", "1 kdeg", "1e306 kN"})
        CHECK_THROWS_AS(parse_as(text, "N"), Error);
}

TEST_CASE("the nearest name is suggested, a far one is not") {
    const std::array<std::string, 3> names{"pose", "wrench", "stiffness"};
    CHECK(did_you_mean("pos", names) == "; did you mean 'pose'?");
    CHECK(did_you_mean("stifness", names) == "; did you mean 'stiffness'?");
    CHECK(did_you_mean("zzzz", names).empty());
    const std::vector<std::string> nodes{"dial", "gain"};
    // Two letters exchanged are one mistake.
    CHECK(did_you_mean("gian", nodes) == "; did you mean 'gain'?");
}
