// SPDX-License-Identifier: Apache-2.0
// Logs and sounds with units of their own, as the vibration verbs show them.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>

using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

/// Rows of a sine of 50 Hz at 1 kHz, `peak` high, with decimal commas where asked.
std::string rows(double peak, char separator, bool commas, int count = 2000) {
    std::string text;
    for (int i = 0; i < count; ++i) {
        std::string row = fmt::format("{:.3f}{}{:.6f}\n", 1e-3 * i, separator,
                                      peak * std::sin(2.0 * std::numbers::pi * 50.0 * i / 1000.0));
        if (commas) std::replace(row.begin(), row.end(), '.', ',');
        text += row;
    }
    return text;
}

json first_row(const Outcome& outcome) { return json::parse(outcome.out)["rows"][0]; }

}  // namespace

TEST_CASE("what was understood of a log is said in one line and in JSON, and its header calibrates it") {
    const Folder folder;
    const std::string log =
        folder.write("l.csv", "Logger 7\nStart;2024-05-17\nt;ax\n[s];[g]\n" + rows(1.0, ';', true)).string();
    const Outcome told = folder.tactus("spectrum " + log);
    REQUIRE(told.code == 0);
    CHECK_THAT(told.out,
               ContainsSubstring("read as: semicolon-separated, decimal comma, names in line 3, units in line 4, "
                                 "first row in line 5 (2 lines not used); time: column 't' in s"));
    CHECK_THAT(told.out, ContainsSubstring("even steps of 1 ms"));
    CHECK_THAT(told.out, ContainsSubstring("a value of 1 is 1 g, from the header"));
    const json row = first_row(folder.tactus("spectrum --json " + log));
    CHECK(row["log"]["form"]["separator"] == "semicolon");
    CHECK(row["log"]["form"]["header_line"] == 3);
    CHECK(row["calibration"]["from"] == "the header");
    // A sine of 1 g has 6.934 m/s² rms: 136.82 dB re 1 µm/s².
    CHECK(row["channels"][0]["rms_db"] == Approx(136.82).margin(0.01));
    // An option counts more, and that is said.
    const json option = first_row(folder.tactus("spectrum --json --calibration '2 m/s^2' " + log));
    CHECK(option["channels"][0]["unit"] == "m/s^2");
    CHECK(option["channels"][0]["rms"] == Approx(std::numbers::sqrt2).epsilon(1e-3));
    CHECK_THAT(option["calibration"]["remark"].get<std::string>(), ContainsSubstring("the option counts"));
    // The page of a report says it, too.
    CHECK(folder.tactus("spectrum " + log + " --report " + (folder.path / "r.html").string()).code == 0);
    CHECK_THAT(slurp(folder.path / "r.html"), ContainsSubstring("read as: semicolon-separated, decimal comma"));
    // exposure asks for nothing.
    CHECK(folder.tactus("exposure " + log).code == 0);
}

TEST_CASE("every verb that reads a log warns of its gaps and empty rows, with the time that is missing") {
    const Folder folder;
    std::string gap = "t_s,x [m/s^2],y [m/s^2]\n", empty = gap;
    for (int i = 0; i < 20000; ++i) {
        const double x = std::sin(0.3 * i), y = std::sin(0.3 * i - 0.2);
        const std::string row = fmt::format("{:.4f},{:.5f},{:.5f}\n", 5e-4 * i, x, y);
        if (i < 8000 || i >= 10000) gap += row;
        empty += i % 50 == 7 ? fmt::format("{:.4f},,\n", 5e-4 * i) : row;
    }
    const std::string with_gap = folder.write("gap.csv", gap).string(), lost = folder.write("lost.csv", empty).string();
    for (const char* const verb : {"spectrum", "exposure", "response", "orders --rate 100"}) {
        CAPTURE(verb);
        const Outcome of_gap = folder.tactus(fmt::format("{} {}", verb, with_gap));
        const std::string all = of_gap.out + of_gap.err;
        if (!std::string(verb).starts_with("orders")) {  // which refuses gaps
            CHECK(of_gap.code == 0);
            CHECK_THAT(all, ContainsSubstring("the log has 1 gap: samples of 1 s are missing"));
            CHECK_THAT(all, ContainsSubstring("18000 rows, even steps of 500 µs between gaps"));
        } else {
            CHECK_THAT(all, ContainsSubstring("gap"));
        }
        const Outcome of_lost = folder.tactus(fmt::format("{} {}", verb, lost));
        CHECK_THAT(of_lost.out + of_lost.err, ContainsSubstring("the log has 400 rows without a value, left out"));
    }
    const Outcome figures = folder.tactus("spectrum --json " + with_gap);
    CHECK(first_row(figures)["log"]["lost_s"].get<double>() == Approx(1.0));
    const Outcome compared = folder.tactus(fmt::format("compare --channel 1 {} {}", with_gap, lost));
    CHECK_THAT(compared.out + compared.err, ContainsSubstring("the log has 1 gap: samples of 1 s are missing"));
    CHECK_THAT(compared.out + compared.err, ContainsSubstring("the log has 400 rows without a value, left out"));
}

TEST_CASE("volts of a sensor are an acceleration by its sensitivity, a rate stands in for times") {
    const Folder folder;
    const std::string volts = folder.write("v.csv", "t_s,accel_x_mV\n" + rows(200.0, ',', false)).string();
    const json row = first_row(folder.tactus("spectrum --json --sensitivity '100 mV/g' " + volts));
    CHECK(row["channels"][0]["unit"] == "g");
    CHECK(row["channels"][0]["rms"] == Approx(std::numbers::sqrt2).epsilon(1e-3));
    std::string column = "a [g]\n";
    for (int i = 0; i < 6400; ++i) column += fmt::format("{:.5f}\n", std::sin(2.0 * std::numbers::pi * i / 32.0));
    const std::string single = folder.write("s.txt", column).string();
    CHECK(folder.tactus("spectrum " + single).code == 2);
    const json timed = first_row(folder.tactus("spectrum --json --rate '3.2 kHz' " + single));
    CHECK(timed["sample_rate_hz"] == 3200.0);
    CHECK(timed["channels"][0]["fundamental_hz"].get<double>() == Approx(100.0).margin(0.5));
    CHECK(folder.tactus("orders --sample-rate 3.2kHz --rate 100 " + single).code == 0);
    // Bytes of Latin-1 in a name do not break JSON.
    const std::string old = folder.write("o.csv", "t;a\xb5 [m/s\xb2]\n" + rows(1.0, ';', true)).string();
    CHECK(first_row(folder.tactus("spectrum --json " + old))["channels"][0]["name"] == "aµ");
}

TEST_CASE("a sound that the program made is calibrated without an option") {
    const Folder folder;
    const std::string patch = folder
                                  .write("p.toml", R"(wires = ["tone.signal -> file.in"]
[nodes.tone]
type = "sine"
rate = "48 kHz"
frequency = "100 Hz"
[nodes.file]
type = "record"
rate = "48 kHz"
unit = "m/s^2"
)")
                                  .string();
    REQUIRE(folder.tactus("render " + patch + " --seconds 1 --out " + (folder.path / "out").string()).code == 0);
    const std::string sound = (folder.path / "out" / "file.wav").string();
    const json row = first_row(folder.tactus("spectrum --json " + sound));
    CHECK(row["channels"][0]["calibrated"] == true);
    CHECK(row["channels"][0]["unit"] == "m/s^2");
    CHECK(row["channels"][0]["db_re"] == "1 µm/s²");
    CHECK(folder.tactus("exposure " + sound).code == 0);
}

TEST_CASE("a report of twelve records is smaller than 3 MB", "[slow]") {
    const Folder folder;
    std::filesystem::create_directory(folder.path / "records");
    for (int n = 0; n < 12; ++n) {
        std::string text = "t_s,ax,ay,az\n";
        std::uint32_t state = 7u + static_cast<std::uint32_t>(n);
        const auto noise = [&state] {
            return static_cast<double>((state = state * 1664525u + 1013904223u) >> 8) / 1e7;
        };
        for (int i = 0; i < 20000; ++i)
            text += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f}\n", 1e-4 * i, noise(), noise(), noise());
        folder.write(fmt::format("records/{}.csv", n), text);
    }
    const fs::path report = folder.path / "report.html";
    REQUIRE(folder.tactus("spectrum " + (folder.path / "records").string() + " --report " + report.string()).code == 0);
    CHECK(fs::file_size(report) < 3'000'000);
    CHECK(fs::file_size(report) > 100'000);
}
