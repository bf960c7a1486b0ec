// SPDX-License-Identifier: Apache-2.0
#include "assets/table/time_unit.hpp"

#include "assets/table/sample_log.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

/// Rows at a rate, with times in a unit from a start (both in that unit), as a logger with that unit would write them.
std::string log_in(double seconds, double rate, const std::string& name, bool is_whole, double start, double jitter,
                   std::mt19937& random) {
    std::uniform_real_distribution<double> shift(-jitter, jitter);
    std::string text = name + ",ax\n";
    for (int i = 0; i < 200; ++i) {
        const double time = (i + shift(random)) / rate / seconds;
        if (is_whole)
            text += fmt::format("{}", static_cast<std::int64_t>(start) +
                                          static_cast<std::int64_t>(std::floor(time + 2.0 / rate / seconds)));
        else text += fmt::format("{:.9f}", start + time + 2.0 / rate / seconds);
        text += fmt::format(",{}\n", i % 7);
    }
    return text;
}

}  // namespace

TEST_CASE("of generated logs without a unit of time none is read in a wrong one, and few fast ones are refused") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    int fast = 0, asked = 0;
    for (int i = 0; i < 400; ++i) {
        const table::TimeUnit& unit = table::time_units()[static_cast<std::size_t>(i % 4)];
        const double rate = std::exp(std::log(10.0) + uniform(random) * std::log(1000.0));  // 10 Hz to 10 kHz
        const bool is_whole = unit.seconds < 0.1 && (unit.seconds < 1e-5 || uniform(random) < 0.5);
        const bool is_epoch = uniform(random) < 0.3 && (is_whole || rate < 1e3);
        const double start = is_epoch ? std::floor(1.7e9 / unit.seconds) : std::floor(1000.0 * uniform(random));
        const std::string text =
            log_in(unit.seconds, rate, i % 3 == 0 ? "t" : "time", is_whole, start, 0.2 * uniform(random), random);
        CAPTURE(i, unit.symbol, rate, is_whole, is_epoch);
        fast += rate > 200.0;
        try {
            const table::SampleLog log = table::read_sample_log(text, "l.csv", {});
            CHECK(log.times.back() - log.times.front() == Approx(199.0 / rate).epsilon(0.05));
            CHECK_FALSE(log.form.is_time_unit_stated);
        } catch (const Error& error) {
            CHECK_THAT(error.what(), ContainsSubstring("--time-unit"));
            asked += rate > 200.0;
        }
    }
    CHECK(10 * asked <= fast);
}

TEST_CASE("a named unit of time decides, however the name is written") {
    const auto named = [](const char* name) {
        const std::optional<table::TimeUnit> unit = table::time_unit_in_name(name);
        return unit ? unit->symbol : "none";
    };
    for (const char* name : {"TimeUS", "time_us", "timestamp [us]", "Time in microseconds", "micros", "t_us", "usec",
                             "timeus", "SampleUS", "elapsedMicros", "Zeit (µs)"})
        CHECK(named(name) == std::string("us"));
    for (const char* name :
         {"TimeMS", "ms", "millis", "Unix time (milli seconds)", "epoch_ms", "Timestamp-ms", "timeMs"})
        CHECK(named(name) == std::string("ms"));
    for (const char* name : {"ns", "timestamp_ns", "elapsedRealtimeNanos", "time (ns)", "sensorTimestampNs"})
        CHECK(named(name) == std::string("ns"));
    for (const char* name : {"seconds_elapsed", "Time [s]", "t_s", "secs"}) CHECK(named(name) == std::string("s"));
    for (const char* name : {"time", "t", "times", "timestamp", "x", "status"})
        CHECK(named(name) == std::string("none"));
    CHECK(table::read_sample_log("TimeUS,AccX\n100,1\n725,2\n1350,3\n", "l.csv", {}).times[1] == Approx(725e-6));
}

TEST_CASE("a step that is plausible in two units is refused with both, in none with the step") {
    const auto read = [](const char* text, const char* unit = "") {
        return table::read_sample_log(text, "l.csv", {.time_column = {}, .columns = {}, .time_unit = unit});
    };
    CHECK_THROWS_WITH(read("t,a\n0,1\n0.02,2\n0.04,3\n"), ContainsSubstring("l.csv:1:1") &&
                                                              ContainsSubstring("s (50 Hz) or in ms (5e+04 Hz)") &&
                                                              ContainsSubstring("--time-unit s or --time-unit ms"));
    CHECK(read("t,a\n0,1\n0.02,2\n0.04,3\n", "ms").times[1] == Approx(2e-5));
    CHECK_THROWS_WITH(read("t,a\n0,1\n1e9,2\n2e9,3\n"),
                      ContainsSubstring("mean step of 1e+09") && ContainsSubstring("--time-unit"));
    const table::SampleLog log = read("time,ax (m/s^2)\n0.000,1\n0.625,2\n1.250,3\n1.875,4\n");
    CHECK(log.times[1] == Approx(625e-6));
    CHECK_THAT(table::describe(log.form),
               ContainsSubstring("in ms (no unit is stated; only ms (1600 Hz) is plausible)"));
    CHECK(read("t,a\n0,1\n0,1\n0,1\n").times.size() == 3);
}

TEST_CASE("nanoseconds since 1970 keep their steps, and cells with a unit are read") {
    std::string text = "time,x\n";
    for (int i = 0; i < 50; ++i)
        text += fmt::format("{},{}\n", std::int64_t{1'700'000'000'123'456'789} + i * 125'001, i);
    const table::SampleLog log = table::read_sample_log(text, "l.csv", {});
    for (std::size_t i = 1; i < log.times.size(); ++i) CHECK(log.times[i] - log.times[i - 1] == Approx(125.001e-6));
    CHECK_THAT(log.form.time, ContainsSubstring("dates in ns"));

    const table::SampleLog cells =
        table::read_sample_log("Time,Acc\n0 sec,0.5 g\n0.0005 sec,250 mg\n0.001 sec,-1.5e-1 g\n", "l.csv", {});
    CHECK(cells.times[1] == Approx(0.0005));
    CHECK(cells.units[0]->text == "g");
    CHECK(cells.columns[0][1] == Approx(0.25));
    CHECK(cells.columns[0][2] == Approx(-0.15));
    CHECK(cells.form.is_time_unit_stated);
    CHECK_THROWS_WITH(table::read_sample_log("t_s,a\n0,0.5 g\n1,1 V\n2,3 g\n", "l.csv", {}),
                      ContainsSubstring("l.csv:3:2") && ContainsSubstring("'V'"));
}
