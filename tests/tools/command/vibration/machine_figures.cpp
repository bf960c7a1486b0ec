// SPDX-License-Identifier: Apache-2.0
// What engineers of machines state of a record: shape, distortion, cepstrum, velocity, octave filters, responses.
#include "tests/support/catch.hpp"
#include "tests/tools/record_folder.hpp"

#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

using nlohmann::json;
using tactus::test::add_noise;
using tactus::test::RecordFolder;
using tactus::test::RecordOutcome;
using tactus::test::slurp;
using tactus::test::tones;

namespace {

constexpr double pi = std::numbers::pi;

/// A resonator driven by noise: input and output as channels, the output with noise of its own.
std::vector<double> driven(double frequency, double damping, double rate, double seconds, double noise) {
    const auto count = static_cast<std::size_t>(seconds * rate);
    std::vector<double> drive(count), other(count), both;
    add_noise(drive, 1.0);
    std::vector<double> twice(2 * count);
    add_noise(twice, noise);
    for (std::size_t i = 0; i < count; ++i) other[i] = twice[2 * i + 1];
    // Impulse-invariant: y = 2 r cos w y' - r^2 y'' + g x'.
    const double r = std::exp(-damping * 2.0 * pi * frequency / rate), w = 2.0 * pi * frequency / rate;
    double y1 = 0.0, y2 = 0.0, x1 = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double y = 2.0 * r * std::cos(w) * y1 - r * r * y2 + 0.05 * x1;
        y2 = y1, y1 = y, x1 = drive[i];
        both.push_back(0.2 * drive[i]);
        both.push_back(0.2 * (y + other[i]));
    }
    return both;
}

std::complex<double> resonator(double f, double frequency, double damping, double rate) {
    const double r = std::exp(-damping * 2.0 * pi * frequency / rate), w = 2.0 * pi * frequency / rate;
    const std::complex<double> z = std::polar(1.0, -2.0 * pi * f / rate);
    return 0.05 * z / (1.0 - 2.0 * r * std::cos(w) * z + r * r * z * z);
}

}  // namespace

TEST_CASE("spectrum states kurtosis, skewness, distortion and the velocity of ISO 20816 of a machine") {
    const RecordFolder folder;
    // 4.5 mm/s rms at 80 Hz, with a third of it at 160 Hz and a tenth at 240 Hz, of velocity.
    const double v = 4.5e-3 * std::numbers::sqrt2, w = 2.0 * pi * 80.0;
    folder.sound("fan.wav",
                 tones({{80.0, w * v / 10.0}, {160.0, 2.0 * w * v / 30.0}, {240.0, 3.0 * w * v / 100.0}}, 6.0, 8000.0),
                 1, 8000);
    const RecordOutcome outcome = folder.tactus("spectrum fan.wav --json --full-scale '10 m/s^2'");
    REQUIRE(outcome.code == 0);
    const json channel = outcome.only("rows")["channels"][0];
    CHECK(channel["machine_velocity_rms"].get<double>() ==
          Approx(4.5e-3 * std::sqrt(1.0 + 1.0 / 9.0 + 0.01)).epsilon(2e-3));
    CHECK(channel["thd"].get<double>() == Approx(std::hypot(2.0 / 3.0, 0.3)).epsilon(1e-3));
    // The same by integration of the samples: the velocity has other harmonics, and no acceleration's unit.
    const json velocity =
        folder.tactus("spectrum fan.wav --json --full-scale '10 m/s^2' --integrate velocity --high-pass '5 Hz'")
            .only("rows");
    const json& integrated = velocity["channels"][0];
    CHECK(integrated["unit"] == "m/s");
    CHECK(velocity["integrated"]["to"] == "velocity");
    CHECK(integrated["thd"].get<double>() == Approx(std::hypot(1.0 / 3.0, 0.1)).epsilon(2e-3));
    CHECK(integrated["harmonics"][0]["rms"].get<double>() == Approx(4.5e-3).epsilon(2e-3));
    CHECK(integrated["machine_velocity_rms"].get<double>() ==
          Approx(channel["machine_velocity_rms"].get<double>()).epsilon(5e-3));
    const json displacement =
        folder.tactus("spectrum fan.wav --json --full-scale '10 m/s^2' --integrate displacement --high-pass 5")
            .only("rows");
    CHECK(displacement["channels"][0]["unit"] == "m");
    CHECK(displacement["channels"][0]["harmonics"][0]["rms"].get<double>() == Approx(4.5e-3 / w).epsilon(3e-3));
    CHECK(folder.tactus("spectrum fan.wav --integrate velocity").code == 2);  // not calibrated
    CHECK(folder.tactus("spectrum fan.wav --integrate velocity --full-scale '1 mm/s'").code == 2);

    // Near 10 Hz, where the lobe of a line would be cut at the lower limit.
    for (const double hz : {10.5, 11.0, 12.5}) {
        folder.sound("slow.wav", tones({{hz, 0.1 * std::numbers::sqrt2}}, 20.0, 8000.0), 1, 8000);
        const json slow = folder.tactus("spectrum slow.wav --json --full-scale '10 m/s^2'").only("rows");
        CHECK(slow["channels"][0]["machine_velocity_rms"].get<double>() ==
              Approx(1.0 / (2.0 * pi * hz)).epsilon(2e-3));
    }

    folder.sound("sine.wav", tones({{100.0, 0.5}}, 4.0, 8000.0), 1, 8000);
    const json sine = folder.tactus("spectrum sine.wav --json").only("rows")["channels"][0];
    CHECK(sine["kurtosis"].get<double>() == Approx(1.5).epsilon(1e-3));
    CHECK(std::abs(sine["skewness"].get<double>()) < 1e-3);
    CHECK(sine["machine_velocity_rms"].is_null());  // not calibrated
    CHECK(channel["machine_velocity_coverage"].get<double>() == Approx(5.75 / 6.0).margin(2e-3));

    // A reason is stated where there is no velocity.
    const auto warning_of = [&](const char* name) {
        const json found =
            folder.tactus(std::string("spectrum ") + name + " --json --full-scale '10 m/s^2'").only("rows");
        CHECK(found["channels"][0]["machine_velocity_rms"].is_null());
        return found["channels"][0]["warnings"].dump();
    };
    folder.sound("coarse.wav", tones({{100.0, 0.5}}, 4.0, 1600.0), 1, 1600);
    CHECK(warning_of("coarse.wav").find("no velocity 10 to 1000 Hz: the record is valid up to 800 Hz only") !=
          std::string::npos);
    folder.sound("brief.wav", tones({{100.0, 0.5}}, 0.35, 8000.0), 1, 8000);
    CHECK(warning_of("brief.wav").find("no velocity 10 to 1000 Hz: it needs a stretch of 0.4 s without a gap") !=
          std::string::npos);
}

TEST_CASE("spectrum has octave filters and a cepstrum on request, and with --psd-only the spectrum alone") {
    const RecordFolder folder;
    std::vector<double> x;
    for (int k = 1; k <= 30; ++k) {
        const std::vector<double> one = tones({{25.0 * k, 0.02}}, 6.0, 8000.0);
        if (x.empty()) x.resize(one.size());
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += one[i];
    }
    add_noise(x, 0.01);
    folder.sound("gear.wav", x, 1, 8000);
    const RecordOutcome text = folder.tactus("spectrum gear.wav --octave-filters third --cepstrum c.csv");
    REQUIRE(text.code == 0);
    CHECK(text.out.find("octave filters, Hz (dB rms) ") != std::string::npos);
    CHECK(text.out.find("cepstrum, ms (spacing) ") != std::string::npos);
    CHECK(slurp(folder.path / "c.csv").rfind("quefrency_s,", 0) == 0);
    const json full = folder.tactus("spectrum gear.wav --octave-filters octave --json").only("rows");
    const json& channel = full["channels"][0];
    REQUIRE(!channel["cepstrum"].empty());
    CHECK(channel["cepstrum"][0]["hz"].get<double>() == Approx(25.0).epsilon(0.01));
    bool found = false;
    for (const json& band : channel["filtered_bands"])
        if (std::abs(band["hz"].get<double>() - 251.19) < 0.1) {
            found = true;  // 177.8 to 354.8 Hz: lines 8 to 14 of 0.02/sqrt(2), 7 of them
            CHECK(band["rms"].get<double>() == Approx(0.02 * std::sqrt(3.5)).epsilon(0.05));
        }
    CHECK(found);

    const json only = folder.tactus("spectrum gear.wav --psd-only --json --csv only.csv").only("rows");
    CHECK(folder.tactus("spectrum gear.wav --csv full.csv").code == 0);
    CHECK(slurp(folder.path / "only.csv") == slurp(folder.path / "full.csv"));
    CHECK(only["channels"][0]["rms"].get<double>() == Approx(channel["rms"].get<double>()).epsilon(0.02));
    CHECK_FALSE(only["channels"][0].contains("fundamental_hz"));
    CHECK(folder.tactus("spectrum gear.wav --psd-only --envelope 100:200").code == 2);
}

TEST_CASE("response warns of a peak that its segments smear, and not of one that they resolve") {
    const RecordFolder folder;
    constexpr double rate = 8000.0;
    // Quality 12.
    folder.sound("plate.wav", driven(173.0, 1.0 / 24.0, rate, 40.0, 0.02), 2, 8000);
    const json shorter = folder.tactus("response plate.wav --json --segment 4096").answer();
    REQUIRE(shorter["peaks"].size() == 1);
    CHECK(shorter["peaks"][0]["width_bins"].get<double>() == Approx(7.4).margin(1.0));
    REQUIRE(shorter["warnings"].size() == 1);
    CHECK(shorter["warnings"][0].get<std::string>().find("choose a longer --segment than 4096") != std::string::npos);
    const json longer = folder.tactus("response plate.wav --json --segment 16384").answer();
    REQUIRE(longer["peaks"].size() == 1);
    CHECK(std::abs(longer["peaks"][0]["hz"].get<double>() - 173.0) < 6.0);
    CHECK(longer["warnings"].empty());
    const RecordOutcome text = folder.tactus("response plate.wav --segment 4096");
    CHECK((text.out + text.err).find("-o keeps the delay apart as latency_s") != std::string::npos);
}

TEST_CASE("response lists a peak that is narrower than a bin, and the width of a peak ends at its neighbour") {
    const RecordFolder folder;
    constexpr double rate = 8000.0;
    // Quality 300: 0.6 Hz at half power, where a bin of 4096 samples has 1.95 Hz.
    std::vector<double> bar = driven(173.0, 1.0 / 600.0, rate, 60.0, 0.02);
    for (std::size_t i = 1; i < bar.size(); i += 2) bar[i] *= 0.05;  // within full scale
    folder.sound("bar.wav", bar, 2, 8000);
    const json narrow = folder.tactus("response bar.wav --json --segment 4096").answer();
    REQUIRE(narrow["peaks"].size() == 1);
    CHECK(narrow["peaks"][0]["hz"].get<double>() == Approx(173.0).margin(2.0));
    CHECK(narrow["peaks"][0]["coherence"].get<double>() < 0.8);
    REQUIRE(narrow["warnings"].size() == 1);
    CHECK(narrow["warnings"][0].get<std::string>().find("may be too low by more than the stated uncertainty") !=
          std::string::npos);

    // Two resonances, each of quality 30, that are closer than their half-power points: widths are those of one.
    std::vector<double> pair = driven(400.0, 1.0 / 60.0, rate, 60.0, 0.0);
    const std::vector<double> other = driven(430.0, 1.0 / 60.0, rate, 60.0, 0.0);
    for (std::size_t i = 1; i < pair.size(); i += 2) pair[i] -= other[i];
    folder.sound("pair.wav", pair, 2, 8000);
    const json both = folder.tactus("response pair.wav --json --segment 16384").answer();
    REQUIRE(both["peaks"].size() == 2);
    for (const json& peak : both["peaks"]) {
        CAPTURE(peak.dump());
        CHECK(peak["width_bins"].get<double>() * rate / 16384.0 < 24.0);
    }
}

TEST_CASE("response between two channels is that of the system, with H1 below and H2 above where the output is noisy") {
    const RecordFolder folder;
    constexpr double rate = 4000.0, frequency = 180.0, damping = 0.05;
    folder.sound("hammer.wav", driven(frequency, damping, rate, 40.0, 0.02), 2, 4000);
    const RecordOutcome outcome =
        folder.tactus("response hammer.wav --json --csv curves.csv --out response.csv --plot r.svg --segment 4096");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json answer = outcome.answer();
    REQUIRE(!answer["peaks"].empty());
    const double at = answer["peaks"][0]["hz"].get<double>();
    CHECK(std::abs(at - frequency) < 6.0);
    CHECK(answer["peaks"][0]["level_db"].get<double>() ==
          Approx(20.0 * std::log10(std::abs(resonator(at, frequency, damping, rate)))).margin(0.5));
    std::istringstream rows(slurp(folder.path / "curves.csv"));
    std::string line;
    std::getline(rows, line);
    CHECK(line == "frequency_hz,h1_db,h1_deg,h2_db,h2_deg,hv_db,hv_deg,coherence,h1_deviation");
    int read = 0;
    while (std::getline(rows, line)) {
        std::istringstream cells(line);
        std::vector<double> c;
        for (std::string cell; std::getline(cells, cell, ',');) c.push_back(std::stod(cell));
        REQUIRE(c.size() == 9);
        // H2 = H1 / coherence, Hv is their mean in dB; both have the phase of the cross-spectrum.
        CHECK(c[3] - c[1] == Approx(-20.0 * std::log10(c[7])).margin(1e-5));
        CHECK(c[5] == Approx(0.5 * (c[1] + c[3])).margin(1e-5));
        if (c[0] < 100.0 || c[0] > 300.0) continue;
        ++read;
        const double error = 20.0 * std::log10(std::abs(resonator(c[0], frequency, damping, rate)));
        CHECK(c[1] == Approx(error).margin(5.0 * 8.69 * c[8] + 0.15));
    }
    CHECK(read > 100);
    // 'equalise' accepts what it writes.
    CHECK(folder.tactus("equalise response.csv --band 50:800 --out e.toml").code == 0);
    const RecordOutcome text = folder.tactus("response hammer.wav --estimator hv");
    const std::size_t peaks = text.out.find("peaks with a coherence");
    REQUIRE(peaks != std::string::npos);
    CAPTURE(text.out);
    // The table has the resonance.
    const std::size_t head = text.out.find("frequency, Hz", peaks);
    REQUIRE(head != std::string::npos);
    CHECK(std::stod(text.out.substr(text.out.find('\n', head) + 1)) == Approx(frequency).margin(2.0));
    CHECK(folder.tactus("response hammer.wav --segment 131072").code == 2);  // one segment has a coherence of 1
    CHECK(folder.tactus("response hammer.wav --channel 1").code == 2);
}
