// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/readable.hpp"

#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("numbers are written without exponents and without zeros that say nothing") {
    CHECK(plain(12589.25) == "12589");
    CHECK(plain(0.0001234567) == "0.0001235");
    CHECK(plain(100.0) == "100");
    CHECK(plain(-2.5) == "-2.5");
    CHECK(plain(0.0) == "0");
    CHECK(plain(999.96, 4) == "1000");
    CHECK(plain(1.26e-9, 2) == "1.3×10^-9");
    CHECK(plain(3e20) == "3×10^20");
}

TEST_CASE("a quantity takes the prefix by which its number lies from 1 to 1000") {
    CHECK(readable(12589.25, "Hz") == "12.6 kHz");
    CHECK(readable(44100.0, "Hz", 6) == "44.1 kHz");
    CHECK(readable(333.0829, "Hz", 6) == "333.083 Hz");
    CHECK(readable(999.96, "Hz") == "1 kHz");
    CHECK(readable(0.00035, "s") == "350 µs");
    CHECK(readable(0.0, "Hz") == "0 Hz");
    CHECK(readable(-0.0123, "m/s^2") == "-12.3 mm/s^2");
    // Lengths and times are not made larger, and a unit with a prefix or without one keeps its number.
    CHECK(readable(3600.0, "s") == "3600 s");
    CHECK(readable(1250.0, "m/s^2") == "1250 m/s^2");
    CHECK(readable(0.00012, "full scale") == "0.00012 full scale");
    CHECK(readable(12.0, "") == "12");
    CHECK(axis_number(500.0) == "500");
    CHECK(axis_number(20000.0) == "20k");
    CHECK(axis_number(-1500.0) == "-1.5k");
}
