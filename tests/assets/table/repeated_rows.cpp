// SPDX-License-Identifier: Apache-2.0
#include "assets/table/repeated_rows.hpp"

#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

/// 2000 rows at 1 kHz, each `copies(row)` times.
std::string log_with_copies(const std::function<int(int)>& copies, const std::function<double(int)>& value) {
    std::string text = "t_s,ax\n";
    for (int i = 0; i < 2000; ++i)
        for (int n = 0; n < copies(i); ++n) text += fmt::format("{:.3f},{:.6f}\n", 0.001 * i, value(i));
    return text;
}

double sine_at(int i) { return std::sin(0.7558 * i); }

}  // namespace

TEST_CASE("rows that a logger wrote twice are left out and counted, and the clock stays that of the others") {
    const auto check = [](const std::function<int(int)>& copies, std::size_t left_out) {
        const table::SampleLog log = table::read_sample_log(log_with_copies(copies, sine_at), "l.csv", {});
        REQUIRE(log.times.size() == 2000);
        CHECK(log.form.repeated == left_out);
        CHECK(log.times[1999] == Approx(1.999));
        CHECK(log.columns[0][1999] == Approx(sine_at(1999)).margin(1e-6));
        CHECK_THAT(table::describe(log.form),
                   ContainsSubstring(fmt::format("{} rows that repeat the row before left out", left_out)));
    };
    check([](int) { return 2; }, 2000);
    check([](int i) { return i % 97 == 5 ? 2 : 1; }, 21);
    check([](int i) { return i >= 500 && i < 700 ? 2 : 1; }, 200);
    check([](int i) { return i == 300 ? 5 : 1; }, 4);
}

TEST_CASE("rows of equal times are kept where values differ, where a signal rests, and where it has few levels") {
    const auto rows_of = [](const std::string& text) {
        const table::SampleLog log = table::read_sample_log(text, "l.csv", {});
        CHECK(log.form.repeated == 0);
        return log.times.size();
    };
    const auto twice = [](int) { return 2; };
    CHECK(rows_of(log_with_copies(twice, [](int) { return 1.0; })) == 4000);
    CHECK(rows_of(log_with_copies(twice, [](int i) { return i / 5 % 2 == 0 ? 1.0 : 2.0; })) == 4000);
    // A clock of whole milliseconds at 1.6 kHz.
    std::string coarse = "t_ms,ax\n";
    for (int i = 0; i < 2000; ++i) coarse += fmt::format("{},{:.6f}\n", i * 10 / 16, sine_at(i));
    CHECK(rows_of(coarse) == 2000);
}
