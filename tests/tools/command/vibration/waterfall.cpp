// SPDX-License-Identifier: Apache-2.0
// Waterfalls of orders and frequencies over time and speed.
#include "tests/support/catch.hpp"
#include "tests/tools/record_folder.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using tactus::test::RecordFolder;
using tactus::test::RecordOutcome;
using tactus::test::slurp;
using tactus::test::tones;

namespace {

constexpr double rate = 8000.0, start = 50.0, rise = 30.0;  // Hz, Hz, Hz/s

/// 6 s of a run-up with orders 1 and 3, and its tachometer. Order 1 grows in proportion to the speed.
std::vector<double> run_up() {
    std::vector<double> both;
    for (int i = 0; i < static_cast<int>(6.0 * rate); ++i) {
        const double t = i / rate, turn = 2.0 * std::numbers::pi * (start * t + 0.5 * rise * t * t);
        both.push_back(0.002 * (start + rise * t) * std::sin(turn) + 0.1 * std::sin(3.0 * turn));
        both.push_back(std::sin(turn) > 0.0 ? 1.0 : 0.0);
    }
    return both;
}

}  // namespace

TEST_CASE("a waterfall over orders has in each row the level of each order at that time and rate") {
    const RecordFolder folder;
    folder.sound("run_up.wav", run_up(), 2, 8000);
    const RecordOutcome outcome = folder.tactus(
        "orders run_up.wav --tacho 2 --orders 5 --json --waterfall w.csv --waterfall w.json --waterfall w.svg");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json fall = outcome.answer()["channels"][0]["waterfall"];
    CHECK(fall["over"] == "orders");
    CHECK(fall["against"] == "time");
    const json& columns = fall["columns"];
    REQUIRE(columns.size() == 89);  // to 5.5 orders in sixteenths
    CHECK(columns[16] == 1.0);
    REQUIRE(fall["rows"].size() > 80);
    for (const json& row : fall["rows"]) {
        const double time = row["time_s"], speed = row["rate_hz"];
        CAPTURE(time, speed);
        CHECK(speed == Approx(start + rise * time).epsilon(0.01));
        CHECK(row["rms"][16].get<double>() ==
              Approx(0.002 * (start + rise * time) / std::numbers::sqrt2).epsilon(0.02));
        CHECK(row["rms"][48].get<double>() == Approx(0.1 / std::numbers::sqrt2).epsilon(0.02));
        CHECK(row["rms"][32].get<double>() < 0.003);
    }
    CHECK(json::parse(slurp(folder.path / "w.json"))["channels"][0]["rows"] == fall["rows"]);
    std::istringstream csv(slurp(folder.path / "w.csv"));
    std::string line;
    std::getline(csv, line);
    CHECK(line.starts_with("channel,time_s,rate_hz,rms_0,rms_0.0625,"));
    CHECK(std::count(line.begin(), line.end(), ',') == 2 + 89);
    std::size_t rows = 0;
    while (std::getline(csv, line)) rows += std::count(line.begin(), line.end(), ',') == 2 + 89 ? 1 : 0;
    CHECK(rows == fall["rows"].size());
    const std::string figure = slurp(folder.path / "w.svg");
    for (const char* word : {"order", "time, s", "rms, dB re full scale", "tachometer, "})
        CHECK_THAT(figure, ContainsSubstring(word));
}

TEST_CASE("a waterfall against speed has rows of one rate each, also over frequency") {
    const RecordFolder folder;
    folder.sound("run_up.wav", run_up(), 2, 8000);
    const auto fall = [&](const char* over) {
        const RecordOutcome outcome = folder.tactus(fmt::format(
            "orders run_up.wav --tacho 2 --orders 5 --json --against speed --over {} --waterfall w.png", over));
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        return outcome.answer()["channels"][0]["waterfall"];
    };
    const json orders = fall("orders");
    double before = 0.0;
    for (const json& row : orders["rows"]) {
        const double speed = row["rate_hz"];
        CHECK(row["time_s"].is_null());
        CHECK(speed > before);
        before = speed;
        CHECK(row["rms"][16].get<double>() == Approx(0.002 * speed / std::numbers::sqrt2).epsilon(0.03));
    }
    CHECK(before > 220.0);
    const json frequency = fall("frequency");
    for (const json& row : frequency["rows"]) {
        // The strongest line below the third order is the first.
        const double speed = row["rate_hz"];
        std::size_t best = 0;
        for (std::size_t k = 0; k < frequency["columns"].size() && frequency["columns"][k] < 2.0 * speed; ++k)
            if (row["rms"][k] > row["rms"][best]) best = k;
        CAPTURE(speed);
        CHECK(frequency["columns"][best].get<double>() == Approx(speed).margin(12.0));
    }
}

TEST_CASE("a waterfall over frequency reads the rms of a line, with the times of the whole record") {
    const RecordFolder folder;
    std::vector<double> x = tones({{70.0, 0.1}}, 2.0, rate);
    const std::vector<double> loud = tones({{70.0, 0.5}}, 2.0, rate);
    x.insert(x.end(), loud.begin(), loud.end());
    folder.sound("steady.wav", x, 1, 8000);
    const json fall =
        folder.tactus("orders steady.wav --rate 70 --from 1 --to 4 --json --over frequency --waterfall w.csv")
            .answer()["channels"][0]["waterfall"];
    bool quiet = false, strong = false;
    for (const json& row : fall["rows"]) {
        float most = 0.0F;
        for (const json& rms : row["rms"]) most = std::max(most, rms.get<float>());
        const double time = row["time_s"];
        CAPTURE(time);
        CHECK(time > 1.0);
        CHECK(time < 4.0);
        if (time < 1.8) quiet = true;
        if (time > 2.2) strong = true;
        if (time < 1.8 || time > 2.2)
            CHECK(most == Approx((time < 2.0 ? 0.1 : 0.5) / std::numbers::sqrt2).epsilon(0.01));
    }
    CHECK(quiet);
    CHECK(strong);
    CHECK_THAT(slurp(folder.path / "w.csv"), ContainsSubstring("_hz,"));
}

TEST_CASE("a waterfall that cannot be made says why") {
    const RecordFolder folder;
    folder.sound("steady.wav", tones({{70.0, 0.5}}, 3.0, rate), 1, 8000);
    const auto error = [&](const char* arguments) {
        const RecordOutcome outcome = folder.tactus(std::string("orders steady.wav --rate 70 ") + arguments);
        CHECK(outcome.code == 2);
        return outcome.err;
    };
    CHECK_THAT(error("--against speed --waterfall w.svg"), ContainsSubstring("the rate hardly changes"));
    CHECK_THAT(error("--against speed"), ContainsSubstring("--waterfall"));
    CHECK_THAT(error("--waterfall w.gif"), ContainsSubstring(".svg, .png, .pdf, .csv or .json"));
    // Above half the sample rate there is nothing, in tables and in figures.
    const RecordOutcome high = folder.tactus("orders steady.wav --rate 70 --orders 80 --json --waterfall w.svg");
    const json row = high.answer()["channels"][0]["waterfall"]["rows"][0]["rms"];
    CHECK(row.front().is_number());
    CHECK(row.back().is_null());
}
