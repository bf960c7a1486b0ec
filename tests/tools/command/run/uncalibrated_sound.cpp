// SPDX-License-Identifier: Apache-2.0
// A sound without calibration in the place of the saw's recordings.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <sndfile.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

/// A saw at 190 Hz with that amplitude, relative to full scale.
std::string sound_of(const Folder& folder, const char* name, double amplitude) {
    SF_INFO info{};
    info.samplerate = 48000;
    info.channels = 1;
    info.format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    std::vector<double> samples;
    for (int i = 0; i < 2 * info.samplerate; ++i) {
        double sum = 0.0;
        for (int k = 1; k <= 4; ++k) sum += std::sin(2.0 * std::numbers::pi * k * 190.0 * i / info.samplerate) / k;
        samples.push_back(amplitude * sum);
    }
    SNDFILE* file = sf_open((folder.path / name).c_str(), SFM_WRITE, &info);
    REQUIRE(file);
    sf_write_double(file, samples.data(), static_cast<sf_count_t>(samples.size()));
    sf_close(file);
    return (folder.path / name).string();
}

struct Played {
    json actuator, saw;
    std::string text;
};

Played played(const Folder& folder, const std::string& arguments) {
    const std::string out = (folder.path / "out").string();
    const Outcome outcome =
        folder.tactus("render saw-vibration --seconds 2 --overwrite --out " + out + " " + arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json summary = json::parse(slurp(out + "/summary.json"));
    return {summary["actuator"], summary.value("saw", json()), outcome.out + outcome.err};
}

}  // namespace

TEST_CASE("a sound without calibration is played as strongly as a saw, and the summary says so") {
    const Folder folder;
    const Played bundled = played(folder, ""), loud = played(folder, "--asset saw=" + sound_of(folder, "a.wav", 0.4)),
                 soft = played(folder, "--asset saw=" + sound_of(folder, "b.wav", 0.004));
    const double level = bundled.actuator["loudest_rms_V"];
    CHECK(level > 0.1);
    for (const Played* one : {&loud, &soft}) {
        CHECK(one->actuator["loudest_rms_V"].get<double>() > 0.3 * level);
        CHECK(one->actuator["loudest_rms_V"].get<double>() < 3.0 * level);
        CHECK(one->text.find("not calibrated: the strongest is played as 100 m/s^2 rms") != std::string::npos);
        CHECK(one->saw["note"].get<std::string>().starts_with("the recordings are not calibrated"));
    }
    CHECK(loud.actuator["loudest_rms_V"].get<double>() ==
          Approx(soft.actuator["loudest_rms_V"].get<double>()).epsilon(1e-4));
    CHECK(bundled.text.find("not calibrated") == std::string::npos);
    CHECK_FALSE(bundled.actuator.contains("note"));
}

TEST_CASE("a vibration that no hand feels is said to be so") {
    const Folder folder;
    const Played weak = played(folder, "--set saw.gain=0.0005");
    CHECK(weak.actuator["loudest_rms_m_s2"] < 0.05);
    CHECK(weak.text.find("below what a hand feels, about 0.05 m/s^2") != std::string::npos);
}
