// SPDX-License-Identifier: Apache-2.0
#include "assets/table/packed_column.hpp"

#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

using namespace tactus;

namespace {

bool is_same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

std::vector<double> parsed(std::size_t count, const char* form, double scale) {
    const Random random{7};
    std::vector<double> values;
    for (std::size_t n = 0; n < count; ++n)
        values.push_back(
            std::strtod(fmt::format(fmt::runtime(form), scale * (random.uniform(n) - 0.5)).c_str(), nullptr));
    return values;
}

table::PackedColumn packed(const std::vector<double>& values) {
    table::PackedColumn column;
    for (const double value : values) column.push_back(value);
    return column;
}

}  // namespace

TEST_CASE("a packed column gives every number back to the last bit") {
    std::vector<double> special(9000, 0.25);
    constexpr std::array extremes{-0.0,
                                  -5e-17,
                                  1e300,
                                  5e-324,
                                  std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<double>::quiet_NaN(),
                                  9007199254740993.0,
                                  -1e15,
                                  1e-15};
    for (std::size_t n = 0; n < extremes.size(); ++n) special[n * 1000] = extremes[n];
    std::vector<double> clock, mixed = parsed(5000, "{:.3f}", 10.0);
    for (int n = 0; n < 20000; ++n) clock.push_back(n / 3200.0);
    for (const double value : parsed(9000, "{:.17g}", 1.0)) mixed.push_back(value);
    for (const double value : parsed(9000, "{:.1f}", 1e6)) mixed.push_back(value);
    for (const std::vector<double>& values : {parsed(10000, "{:.6f}", 3.0), parsed(10000, "{:.0f}", 65535.0),
                                              parsed(10000, "{:.2e}", 1e9), special, clock, mixed}) {
        const table::PackedColumn column = packed(values);
        REQUIRE(column.size() == values.size());
        std::size_t different = 0;
        const std::vector<double> back = column.values();
        for (std::size_t n = 0; n < values.size(); ++n) different += !is_same(back[n], values[n] + 0.0);
        CHECK(different == 0);
        CHECK(is_same(column[4097], values[4097]));
    }
}

TEST_CASE("a packed column of few digits takes at most half of the memory, and a clock none") {
    CHECK(packed(parsed(40960, "{:.6f}", 3.0)).bytes() < 40960 * 4 + 40000);
    CHECK(packed(parsed(40960, "{:.0f}", 200.0)).bytes() < 40960 * 1 + 40000);
    std::vector<double> clock;
    for (int n = 0; n < 409600; ++n) clock.push_back(n / 10000.0);
    CHECK(packed(clock).bytes() < 45000);
}

TEST_CASE("a part of a packed column is read with its scale") {
    std::vector<double> values;
    for (int n = 0; n < 10000; ++n) values.push_back((n * 37 % 1001) * 0.01);
    table::PackedColumn column = packed(values);
    column.scale(1e-3, 4.0);
    column.cut(4000, 9000);
    REQUIRE(column.size() == 5000);
    std::vector<double> part(300);
    column.read(50, part);
    for (std::size_t n = 0; n < part.size(); ++n) CHECK(part[n] == values[4050 + n] * 1e-3 / 4.0);
    CHECK(column.back() == values[8999] * 1e-3 / 4.0);
}
