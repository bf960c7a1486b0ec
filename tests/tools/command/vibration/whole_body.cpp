// SPDX-License-Identifier: Apache-2.0
// exposure --body: whole-body vibration, as scripts call it.
#include "dsp/signal/exposure/whole_body.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/record_folder.hpp"

#include <cmath>
#include <numbers>
#include <regex>
#include <string>
#include <vector>

using namespace tactus;
using nlohmann::json;
using tactus::test::RecordFolder;
using tactus::test::RecordOutcome;
using tactus::test::tones;

namespace {

/// Channels one after another in each frame.
std::vector<double> interleaved(const std::vector<std::vector<double>>& channels) {
    std::vector<double> all;
    for (std::size_t i = 0; i < channels.front().size(); ++i)
        for (const std::vector<double>& channel : channels) all.push_back(channel[i]);
    return all;
}

}  // namespace

TEST_CASE("exposure of the whole body weights each axis, and A(8) is that of the strongest with its factor") {
    const RecordFolder folder;
    constexpr double rate = 2000.0, seconds = 60.0;
    folder.sound("seat.wav",
                 interleaved({tones({{2.0, 0.084}}, seconds, rate), tones({{4.0, 0.05}}, seconds, rate),
                              tones({{6.0, 0.06}}, seconds, rate)}),
                 3, 2000);
    const RecordOutcome outcome =
        folder.tactus("exposure seat.wav --body whole --json --full-scale '10 m/s^2' --duration '4 h'");
    REQUIRE(outcome.code == 0);
    const json answer = outcome.answer();
    const json axes = answer["operations"][0]["axes"];
    REQUIRE(axes.size() == 3);
    struct Wanted {
        const char *axis, *weighting;
        double frequency, amplitude, factor;
        const signal::Weighting& definition;
    };
    double strongest = 0.0;
    for (std::size_t i = 0; const Wanted& wanted : {Wanted{"x", "Wd", 2.0, 0.84, 1.4, signal::weighting_d},
                                                    {"y", "Wd", 4.0, 0.5, 1.4, signal::weighting_d},
                                                    {"z", "Wk", 6.0, 0.6, 1.0, signal::weighting_k}}) {
        const json& axis = axes[i++];
        CAPTURE(wanted.axis);
        const double rms = wanted.amplitude / std::numbers::sqrt2 * std::abs(wanted.definition(wanted.frequency));
        CHECK(axis["axis"] == wanted.axis);
        CHECK(axis["weighting"] == wanted.weighting);
        CHECK(axis["factor"] == wanted.factor);
        CHECK(axis["a_w"].get<double>() == Approx(rms).epsilon(0.005));
        CHECK(axis["a_w_filter"].get<double>() == Approx(rms).epsilon(0.01));
        CHECK(axis["vdv"].get<double>() == Approx(rms * std::pow(1.5 * seconds, 0.25)).epsilon(0.01));
        CHECK(axis["vdv_day"].get<double>() ==
              Approx(wanted.factor * rms * std::pow(1.5 * 4.0 * 3600.0, 0.25)).epsilon(0.01));
        CHECK(axis["mtvv"].get<double>() == Approx(rms).epsilon(0.06));
        CHECK(axis["shocks"] == false);
        strongest = std::max(strongest, wanted.factor * rms);
        // Time to the action value is 8 h (0.5 / k a_w)².
        CHECK(axis["minutes_to_action"].get<double>() ==
              Approx(480.0 * std::pow(0.5 / (wanted.factor * rms), 2.0)).epsilon(0.01));
    }
    CHECK(answer["day"]["a8_axis"] == "x");
    CHECK(answer["day"]["a8"].get<double>() == Approx(strongest * std::sqrt(0.5)).epsilon(0.005));
    CHECK(answer["day"]["verdict"] == "above_action");  // 0.52
    CHECK(answer["day"]["shocks"] == false);
    CHECK(answer["operations"][0]["lower_bound"] == false);
    // Two halves of the day are the day.
    const json two =
        folder
            .tactus("exposure seat.wav seat.wav --body whole --json --full-scale '10 m/s^2' --duration 2 --duration 2")
            .answer();
    CHECK(two["day"]["a8"].get<double>() == Approx(answer["day"]["a8"].get<double>()).epsilon(1e-9));
    CHECK(two["day"]["vdv"].get<double>() == Approx(answer["day"]["vdv"].get<double>()).epsilon(1e-9));
    // In a train the vertical axis has Wb, and no factor or limit applies.
    const json rail = folder.tactus("exposure seat.wav --body rail --json --full-scale '10 m/s^2'").answer();
    CHECK(rail["operations"][0]["axes"][0]["factor"] == 1.0);
    CHECK(rail["operations"][0]["axes"][2]["weighting"] == "Wb");
    CHECK(rail["operations"][0]["axes"][2]["a_w"].get<double>() ==
          Approx(0.6 / std::numbers::sqrt2 * std::abs(signal::weighting_b(6.0))).epsilon(0.005));
    CHECK(rail["day"].is_null());
}

TEST_CASE("shocks that A(8) misses are judged by the dose, and one axis alone is never judged as kept") {
    const RecordFolder folder;
    constexpr double rate = 1000.0;
    // A quiet seat and a pothole every 20 s: half a sine of 40 m/s² for 80 ms.
    std::vector<double> z = tones({{5.0, 0.001}}, 60.0, rate);
    for (const double at : {10.0, 30.0, 50.0})
        for (int i = 0; i < 80; ++i)
            z[static_cast<std::size_t>(at * rate) + static_cast<std::size_t>(i)] +=
                0.4 * std::sin(std::numbers::pi * i / 80.0);
    const std::vector<double> still = tones({{3.0, 0.0005}}, 60.0, rate);
    folder.sound("potholes.wav", interleaved({still, still, z}), 3, 1000);
    const json day =
        folder.tactus("exposure potholes.wav --body whole --json --full-scale '100 m/s^2' --duration '10 min'")
            .answer()["day"];
    CHECK(day["shocks"] == true);
    CHECK(day["verdict_a8"] == "below_action");
    CHECK(day["verdict_vdv"] == "above_limit");
    CHECK(day["verdict"] == "above_limit");

    folder.text("log.csv", [] {
        std::string text = "time_s,accel_z\n";
        for (int i = 0; i < 4000; ++i)
            text += fmt::format("{},{}\n", i / 400.0, 0.1 * std::sin(2.0 * std::numbers::pi * 5.0 * i / 400.0));
        return text;
    }());
    const json alone = folder.tactus("exposure log.csv --body whole --json --calibration '1 m/s^2'").answer();
    CHECK(alone["operations"][0]["axes"][0]["axis"] == "z");
    CHECK(alone["operations"][0]["lower_bound"] == true);
    CHECK(alone["day"]["verdict"] == "cannot_be_judged");
    // A single channel without such a name needs its axis.
    folder.sound("one.wav", z, 1, 1000);
    const RecordOutcome unnamed = folder.tactus("exposure one.wav --body whole --full-scale '100 m/s^2'");
    CHECK(unnamed.code == 2);
    CHECK(unnamed.err.find("--axes z") != std::string::npos);
    CHECK(folder.tactus("exposure one.wav --body whole --axes zz --full-scale '100 m/s^2'").code == 2);
    CHECK(folder.tactus("exposure one.wav --axes z --full-scale '100 m/s^2'").code == 2);
    const RecordOutcome text =
        folder.tactus("exposure one.wav --body whole --axes z --full-scale '100 m/s^2' --table t.csv");
    CHECK(text.code == 0);
    CHECK(std::regex_search(text.out, std::regex("\\n +axis +channel +weighting")));
    CHECK(std::regex_search(text.out, std::regex("\\n +z +[^ ]+ +Wk ")));
    CHECK(tactus::test::slurp(folder.path / "t.csv").find("one.wav,z,Wk,1,") != std::string::npos);
}
