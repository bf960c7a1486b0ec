// SPDX-License-Identifier: Apache-2.0
#include "assets/table/recording.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/written_recordings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::vector<double> wave(std::size_t count, double scale = 1.0) {
    std::vector<double> values;
    // Numbers that single precision and five digits hold.
    for (std::size_t n = 0; n < count; ++n) values.push_back(scale * (static_cast<double>(n * 7 % 64) - 31.0) / 32.0);
    return values;
}

std::vector<double> clock_of(std::size_t count, double step) {
    std::vector<double> times;
    for (std::size_t n = 0; n < count; ++n) times.push_back(step * static_cast<double>(n));
    return times;
}

struct Recordings {
    TemporaryFolder folder;
    table::SampleLog load(const std::string& name, const std::string& bytes,
                          const table::LogSelection& how = {}) const {
        file::write_whole_file(folder / name, bytes);
        return table::load_sample_log(folder / name, how);
    }
};

double largest_difference(const table::PackedColumn& a, const std::vector<double>& b) {
    REQUIRE(a.size() == b.size());
    double worst = 0.0;
    for (std::size_t n = 0; n < b.size(); ++n) worst = std::max(worst, std::abs(a[n] - b[n]));
    return worst;
}

}  // namespace

TEST_CASE(
    "functions of a universal file are read in text and binary, single and double, even and uneven, in both byte "
    "orders") {
    const Recordings place;
    for (const int type : {2, 4})
        for (const bool is_even : {true, false})
            for (const auto& [is_binary, big] : {std::pair{false, false}, {true, false}, {true, true}}) {
                CAPTURE(type, is_even, is_binary, big);
                test::UniversalFunction f;
                f.type = type, f.is_even = is_even, f.is_binary = is_binary, f.big = big;
                f.values = wave(100), f.times = clock_of(100, 5e-4);
                const table::SampleLog log = place.load("a.uff", test::universal_function(f));
                CHECK(log.names == std::vector<std::string>{"12Z+"});
                REQUIRE(log.units[0]);
                CHECK(log.units[0]->text == "m/s^2");
                CHECK(largest_difference(log.columns[0], wave(100)) < 1e-5);
                CHECK(largest_difference(log.times, clock_of(100, 5e-4)) < 1e-8);
            }
}

TEST_CASE("the unit of an abscissa holds for even functions as for uneven ones, and an unknown one is refused") {
    const Recordings place;
    test::UniversalFunction f;
    f.values = wave(100), f.times = clock_of(100, 0.5);
    f.time_unit = "ms", f.step = 0.5, f.start = 20.0;
    for (const bool is_even : {true, false}) {
        f.is_even = is_even;
        const table::SampleLog log = place.load("a.uff", test::universal_function(f));
        CHECK(log.times[99] - log.times[0] == Approx(99 * 0.5e-3).epsilon(1e-4));
    }
    f.is_even = true, f.time_unit = "furlong";
    CHECK_THROWS_WITH(place.load("a.uff", test::universal_function(f)), ContainsSubstring("'furlong'"));
}

TEST_CASE("numbers of a universal file have exponents of any length, and none is lost or added without a word") {
    const Recordings place;
    test::UniversalFunction f;
    f.values = {1.0, 2.0, 3.0, 4.0};
    const std::string text = test::universal_function(f), first = "  1.00000E+00";
    REQUIRE(text.find(first) != std::string::npos);
    const auto with = [&](const std::string& word) {
        std::string changed = text;
        return changed.replace(changed.find(first), first.size(), word);
    };
    // Fortran leaves the letter out of an exponent of three digits.
    table::SampleLog log = place.load("a.uff", with(" 1.23457-101"));
    CHECK(log.columns[0][0] == 1.23457e-101);
    CHECK(log.columns[0][1] == 2.0);
    CHECK(place.load("a.uff", with(" 1.5D+02")).columns[0][0] == 150.0);
    CHECK_THROWS_WITH(place.load("a.uff", with("1.00000-2.00000")), ContainsSubstring("more are there"));
    CHECK(place.load("a.uff", with("  1.00000E-400")).columns[0][0] == 0.0);
    log = place.load("a.uff", with("  1.00000E+400"));
    CHECK(log.lost_rows == 1);
    CHECK_THROWS_WITH(place.load("a.uff", with("  1.00000E+00  7.0")), ContainsSubstring("more are there"));
}

TEST_CASE("a universal file may end with blank lines, and thousands of functions of one name are told apart") {
    const Recordings place;
    test::UniversalFunction f;
    f.values = wave(2);
    std::string text;
    for (int n = 0; n < 3000; ++n) text += test::universal_function(f);
    const table::Recording recording = table::read_universal_file(text + "\n  \r\n\x1a", "a.uff");
    REQUIRE(recording.channels.size() == 3000);
    CHECK(recording.channels[0].name == "12Z+");
    CHECK(recording.channels[2999].name == "12Z+ (3000)");
}

TEST_CASE("a universal file of several datasets gives the functions of time, and counts what is left out") {
    const Recordings place;
    test::UniversalFunction x, y, spectrum, slow;
    x.values = wave(40), y.values = wave(40, 2.0), y.direction = -1;
    spectrum.values = wave(40), spectrum.abscissa = 18;
    const std::string model = "    -1\n   151\nthe model\n    -1\n";
    const table::SampleLog log =
        place.load("a.unv", model + test::universal_function(x) + test::universal_function(spectrum) +
                                test::universal_function(y));
    CHECK(log.names == std::vector<std::string>{"12Z+", "12X-"});
    CHECK(largest_difference(log.columns[1], wave(40, 2.0)) < 1e-5);
    CHECK(log.form.format ==
          "universal file, 2 of 4 datasets; 1 of other kinds left out; 1 functions of another abscissa "
          "than time left out");
    slow.values = wave(20), slow.step = 0.01, slow.node = 7;
    const std::string two = test::universal_function(x) + test::universal_function(slow);
    CHECK_THROWS_WITH(place.load("b.unv", two),
                      ContainsSubstring("12Z+ (2000 Hz, 40 samples), 7Z+ (100 Hz, 20 samples)"));
    table::LogSelection how;
    how.columns = {"7Z+"};
    CHECK(place.load("b.unv", two, how).times[1] == 0.01);
    // Units of dataset 164, SI.
    x.unit = "NONE";
    CHECK_FALSE(place.load("c.unv", test::universal_function(x)).units[0]);
    CHECK(place.load("c.unv", "    -1\n   164\n         1SI                  2\n    -1\n" + test::universal_function(x))
              .units[0]
              ->text == "m/s^2");
}

TEST_CASE("channels of a recording are named in lists like columns, also those with a comma in their name") {
    const Recordings place;
    test::UniversalFunction x, y;
    x.values = wave(40), x.node = 12;
    y = x, y.node = 13;
    const std::string both = test::universal_function(x) + test::universal_function(y);
    table::LogSelection how;
    how.columns = {"12Z+,13Z+"};
    CHECK(place.load("a.unv", both, how).names == std::vector<std::string>{"12Z+", "13Z+"});
    how.columns = {"\"13Z+\",1"};
    CHECK(place.load("a.unv", both, how).names == std::vector<std::string>{"13Z+", "12Z+"});
    how.list_entry = 1;
    how.columns = {"12Z+,13Z+"};
    CHECK(place.load("a.unv", both, how).names == std::vector<std::string>{"13Z+"});
}

TEST_CASE("a universal file cut anywhere is refused or loses nothing that it states") {
    const Recordings place;
    for (const bool is_binary : {false, true}) {
        test::UniversalFunction f;
        f.is_binary = is_binary, f.values = wave(50);
        const std::string whole = test::universal_function(f);
        for (std::size_t size = 0; size + 1 < whole.size(); size += 7) {
            CAPTURE(is_binary, size);
            try {
                const table::SampleLog log = place.load("a.uff", whole.substr(0, size));
                CHECK(log.times.size() == 50);
            } catch (const Error&) {
            }
        }
    }
    test::UniversalFunction f;
    f.values = wave(50);
    std::string many = test::universal_function(f);
    many.replace(many.find("        50"), 10, " 999999999");
    CHECK_THROWS_WITH(place.load("a.uff", many), ContainsSubstring("more than the dataset holds"));
}

TEST_CASE("vectors and matrices of a MATLAB file are channels in both byte orders, packed or not") {
    const Recordings place;
    for (const bool big : {false, true}) {
        CAPTURE(big);
        const std::string file = test::matlab_file(test::matlab_numbers("t", 1, 60, clock_of(60, 1.0 / 1600.0), big) +
                                                       test::matlab_numbers("ax", 60, 1, wave(60, 32.0), big, 3) +
                                                       test::matlab_numbers("ay", 60, 1, wave(60), big, 7),
                                                   big);
        const table::SampleLog log = place.load("a.mat", file);
        CHECK(log.names == std::vector<std::string>{"ax", "ay"});
        CHECK(log.time_name == "t");
        CHECK(largest_difference(log.columns[0], wave(60, 32.0)) == 0.0);
        CHECK(largest_difference(log.times, clock_of(60, 1.0 / 1600.0)) < 1e-15);
    }
    std::vector<double> both = wave(60);
    const std::vector<double> second = wave(60, 0.5);
    both.insert(both.end(), second.begin(), second.end());
    const std::string packed = test::matlab_file(test::matlab_packed(test::matlab_numbers("data", 60, 2, both)) +
                                                 test::matlab_packed(test::matlab_numbers("fs", 1, 1, {3200.0})));
    table::LogSelection how;
    how.columns = {"data_2"};
    const table::SampleLog log = place.load("b.mat", packed, how);
    CHECK(log.columns[0] == second);
    CHECK(log.times[1] == 1.0 / 3200.0);
    CHECK_THAT(log.form.time, ContainsSubstring("variable 'fs'"));
}

TEST_CASE(
    "the fields of a structure in a MATLAB file have their own names, and a stated rate decides on the unit of time") {
    const Recordings place;
    std::string names("time\0\0\0\0acc_g\0\0\0", 16);
    const auto field = [](const std::vector<double>& values) { return test::matlab_numbers("", 60, 1, values); };
    // The structure is called as a unit is.
    const std::string structure =
        test::matlab_element(14, test::matlab_array(2, "s", 1, 1) + test::bytes_of(std::uint32_t{0x40005}) +
                                     test::bytes_of(std::int32_t{8}) + test::matlab_element(1, names) +
                                     field(clock_of(60, 0.5)) + field(wave(60)));
    const std::string rate = test::matlab_numbers("Fs", 1, 1, {2000.0});
    const table::SampleLog log = place.load("a.mat", test::matlab_file(structure + rate));
    CHECK(log.names == std::vector<std::string>{"acc_g"});
    CHECK(log.units[0]->text == "g");
    CHECK(log.times[1] == Approx(5e-4));
    CHECK_THAT(log.form.time, ContainsSubstring("'time' in ms"));
}

TEST_CASE("channels of different lengths, MATLAB 7.3 and damaged files are refused with what to do") {
    const Recordings place;
    const std::string two =
        test::matlab_file(test::matlab_numbers("x", 60, 1, wave(60)) + test::matlab_numbers("y", 50, 1, wave(50)));
    CHECK_THROWS_WITH(place.load("a.mat", two), ContainsSubstring("x (60 samples), y (50 samples)"));
    table::LogSelection how;
    how.columns = {"y"}, how.rate = 1000.0;
    CHECK(place.load("a.mat", two, how).columns[0] == wave(50));
    CHECK_THROWS_WITH(place.load("b.mat", "MATLAB 7.3 MAT-file" + std::string(200, ' ')), ContainsSubstring("'-v7'"));
    CHECK_THROWS_WITH(place.load("c.mat", test::matlab_file(test::matlab_numbers("x", 1000000, 1000, wave(60)))),
                      ContainsSubstring("fewer numbers than its dimensions state"));
    how.columns = {"x"};
    const std::string whole = test::matlab_file(test::matlab_packed(test::matlab_numbers("x", 60, 1, wave(60))));
    for (std::size_t size = 0; size < whole.size(); size += 3) {
        CAPTURE(size);
        CHECK_THROWS_AS(place.load("d.mat", whole.substr(0, size), how), Error);
    }
}

TEST_CASE("variables of one name in a MATLAB file are told apart") {
    const Recordings place;
    const std::string t = test::matlab_numbers("t", 40, 1, clock_of(40, 1e-3));
    const std::string a = test::matlab_numbers("a", 40, 1, wave(40)),
                      b = test::matlab_numbers("a", 40, 1, wave(40, 2.0));
    table::LogSelection how;
    how.columns = {"a (2)"};
    CHECK(largest_difference(place.load("a.mat", test::matlab_file(t + a + b), how).columns[0], wave(40, 2.0)) == 0.0);
}

TEST_CASE("the channels of all functions or variables of a file together must fit in the memory for one file") {
    const Recordings place;
    test::UniversalFunction f;
    f.is_binary = true, f.type = 2, f.step = 1e-3;
    f.values = wave(1000);
    std::string universal, matlab;
    for (int n = 0; n < 100; ++n) {
        universal += test::universal_function(f);
        matlab += test::matlab_packed(test::matlab_numbers(fmt::format("x{}", n), 1000, 1, std::vector(1000, 1.0)));
    }
    table::LogSelection how;
    how.columns = {"1"}, how.rate = 1000.0;
    const std::uint64_t before = file::memory_limit();
    // A variable is unpacked in blocks of a megabyte, of which two are counted.
    for (const auto& [name, bytes, limit] :
         {std::tuple{"a.uff", universal, 1'500'000}, {"a.mat", test::matlab_file(matlab), 3'000'000}}) {
        CAPTURE(name, bytes.size());
        file::set_memory_limit(static_cast<std::uint64_t>(limit));
        std::string said;
        try {
            place.load(name, bytes, how);
        } catch (const file::NoRoom& error) {
            said = error.what();
        }
        file::set_memory_limit(before);
        CHECK_THAT(said, ContainsSubstring(name) && ContainsSubstring("--memory"));
        CHECK(place.load(name, bytes, how).times.size() == 1000);
    }
}

TEST_CASE("ten thousand variables of one name in a MATLAB file are told apart in time that grows with them") {
    const Recordings place;
    std::string variables;
    for (int n = 0; n < 10000; ++n)
        variables += test::matlab_numbers("a", 4, 1, {1.0, 2.0, 3.0, static_cast<double>(n)});
    table::LogSelection how;
    how.columns = {"a (10000)"}, how.rate = 1000.0;
    CHECK(place.load("a.mat", test::matlab_file(variables), how).columns[0].back() == 9999.0);
}
