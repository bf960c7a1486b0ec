// SPDX-License-Identifier: Apache-2.0
// measure, equalise and compare as scripts call them: the loop from a sweep to a vibration that is the saw's.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/peak_memory.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <sndfile.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <regex>
#include <vector>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;
namespace fs = std::filesystem;

namespace {

struct SoundShape {
    int rate = 48000, channels = 1, format = SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    double seconds = 3.0;
};

fs::path sound_of(const Folder& folder, const std::string& name, const std::function<double(double)>& value,
                  const SoundShape& shape = {}) {
    SF_INFO info{};
    info.samplerate = shape.rate;
    info.channels = shape.channels;
    info.format = shape.format;
    const fs::path path = folder.path / name;
    SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
    REQUIRE(file != nullptr);
    std::vector<float> samples;
    for (int i = 0; i < static_cast<int>(shape.seconds * shape.rate); ++i)
        for (int c = 0; c < shape.channels; ++c)
            samples.push_back(static_cast<float>(value(static_cast<double>(i) / shape.rate)));
    sf_writef_float(file, samples.data(), static_cast<sf_count_t>(samples.size()) / shape.channels);
    sf_close(file);
    return path;
}

/// A saw-like tone with a little noise that differs with `seed`.
std::function<double(double)> saw(double hz, double level = 0.5, std::uint64_t seed = 1) {
    return [=, state = seed](double t) mutable {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        const double noise = static_cast<double>(state >> 11) * 0x1.0p-53 - 0.5;
        double sum = 0.02 * noise;
        for (int k = 1; k <= 4; ++k) sum += std::sin(2.0 * std::numbers::pi * k * hz * t + k * k) / k;
        return level * sum;
    };
}

json compared(const Folder& folder, const std::string& arguments, int code) {
    const Outcome outcome = folder.tactus("compare --json " + arguments);
    INFO(outcome.err);
    REQUIRE(outcome.code == code);
    const json answer = json::parse(outcome.out);
    REQUIRE(answer["pairs"].size() == 1);
    CHECK(answer["verdict"] == answer["pairs"][0]["verdict"]);
    return answer["pairs"][0];
}

}  // namespace

TEST_CASE(
    "measure finds the actuator's resonance in a patch, and equalise makes a filter of it that the patch can use") {
    const Folder folder;
    const std::string csv = (folder.path / "response.csv").string(), filter = (folder.path / "filter.toml").string();
    const Outcome measured =
        folder.tactus("measure saw-training --in saw.signal --probe actuator.signal --amplitude 100 --json -o " + csv);
    INFO(measured.err);
    REQUIRE(measured.code == 0);
    const json result = json::parse(measured.out);
    // 73 Hz and 0.33 on 20 g; on 300 g, by the reduced mass of 4.4 g and the rest, both times 0.8894.
    CHECK(result["resonance_hz"].get<double>() == Approx(64.93).epsilon(0.01));
    CHECK(result["damping_ratio"].get<double>() == Approx(0.2935).epsilon(0.01));
    CHECK(result["latency_s"].get<double>() == Approx(0.0).margin(1e-4));
    CHECK(result["response_csv"] == csv);
    CHECK(tactus::test::broken_schema(folder, "measure", result) == "");
    REQUIRE(result["thd"].size() >= 2);
    CHECK(result["thd"][0]["order"] == 2);
    CHECK(result["thd"][0]["percent"] < 0.1);
    CHECK(slurp(csv).find("frequency_hz,level_db,phase_deg,coherence") != std::string::npos);

    for (const char* kind : {"minimum", "linear"}) {
        const Outcome made =
            folder.tactus("equalise " + csv + " -o " + filter + " --json --volts 0.008 --kind " + kind);
        INFO(made.err);
        REQUIRE(made.code == 0);
        const json equaliser = json::parse(made.out);
        CHECK(equaliser["deviation_after_db"].get<double>() < 1.0);
        CHECK(equaliser["deviation_before_db"].get<double>() > 3.0);
        CHECK(equaliser["delay_s"].get<double>() <= (std::string(kind) == "minimum" ? 0.002 : 0.0641));
        CHECK(equaliser["voltage_limit_v"] == 3.0);
        const Outcome used = folder.tactus("render saw-vibration --seconds 0.1 --asset equaliser=" + filter +
                                           " --overwrite --out " + (folder.path / "out").string());
        INFO(used.err);
        CHECK(used.code == 0);
    }
}

TEST_CASE("a sweep that drives the actuator into its limit shows it as distortion of odd orders", "[slow]") {
    const Folder folder;
    const std::string csv = (folder.path / "response.csv").string();
    const auto third_order = [&](const char* amplitude) {
        const Outcome measured = folder.tactus(std::string("measure saw-training --in actuator.drive --probe "
                                                           "actuator.voltage --json --amplitude ") +
                                               amplitude + " -o " + csv);
        INFO(measured.err);
        REQUIRE(measured.code == 0);
        const json result = json::parse(measured.out);
        CHECK(result["resonance_hz"].is_null());  // a voltage has none
        CHECK(result["thd"][0]["percent"] < 0.5);
        return result["thd"][1]["percent"].get<double>();
    };
    CHECK(third_order("300") < 0.1);   // 2.4 V
    CHECK(third_order("750") > 10.0);  // 6 V where 3 V are the limit: 13.8 % by Fourier's integral
}

TEST_CASE("with its equaliser the bundled actuator plays what the saw did, and without, it does not") {
    const Folder folder;
    const auto play = [&](const std::string& amount, int code) {
        const std::string out = (folder.path / ("amount" + amount)).string();
        const Outcome rendered =
            folder.tactus("render saw-vibration --seconds 4 --set equaliser.amount=" + amount + " --out " + out);
        INFO(rendered.err);
        REQUIRE(rendered.code == 0);
        return compared(folder, out + "/wanted.wav " + out + "/handle.wav --actuator haptuator_large", code);
    };
    const json before = play("0", 1), after = play("1", 0);
    CHECK(before["verdict"] == "fail");
    CHECK(before["lsd_db"] > 3.0);
    CHECK(before["failed"].size() >= 2);
    CHECK(after["verdict"] == "pass");
    CHECK(after["failed"].empty());
    CHECK(after["alignment"] == "correlation");
    CHECK(after["delay_s"].get<double>() == Approx(0.064).margin(1e-4));
    CHECK(after["lsd_db"] < 0.3);
    CHECK(after["harmonic_error_db"] < 0.25);
    CHECK(after["cosine_40_500"] > 0.9995);
    CHECK(after["st_sim"] > 0.95);
    CHECK(after["spqi"] > 0.95);
    CHECK(after["level_gap_db"] > 20.0);
}

TEST_CASE("two takes of one saw pass with null where scores need one recording, and another saw fails") {
    const Folder folder;
    const std::string reference = sound_of(folder, "a.wav", saw(233.0), {.seconds = 6.0}).string();
    const std::string same = sound_of(folder, "b.wav", saw(233.4, 0.1, 77), {.rate = 44100, .seconds = 5.0}).string();
    const json pass = compared(folder, reference + " " + same, 0);
    CHECK(pass["alignment"] == "none");
    for (const char* key : {"delay_s", "st_sim", "spqi", "coherence_mean"}) CHECK(pass[key].is_null());
    CHECK(pass["verdict"] == "pass");
    CHECK(pass["gain_db"].get<double>() == Approx(13.98).margin(0.1));
    CHECK(pass["speed_ratio"].get<double>() == Approx(233.4 / 233.0).epsilon(1e-4));
    for (const char* key :
         {"lsd_db", "cosine_40_500", "cosine_40_1000", "harmonic_error_db", "third_octave", "third_octave_max_db",
          "spectrogram_similarity", "only_in_reference", "only_in_output", "level_gap_db", "failed"})
        CHECK(pass.contains(key));

    const auto hummed = [hum = saw(233.0, 0.5, 5)](double t) mutable {
        return hum(t) + 0.025 * std::sin(2.0 * std::numbers::pi * 50.0 * t);
    };
    const json fail = compared(folder, reference + " " + sound_of(folder, "c.wav", hummed).string(), 1);
    CHECK(fail["verdict"] == "fail");
    REQUIRE(fail["only_in_output"].size() == 1);
    CHECK(fail["only_in_output"][0]["hz"].get<double>() == Approx(50.0).margin(0.1));
    CHECK(fail["only_in_output"][0]["name"] == "mains hum, 50 Hz");
    CHECK(std::ranges::find(fail["failed"], json("only_in_output")) != fail["failed"].end());
    const std::string forgiving = folder.write("t.toml", "added_line_db = false\nlsd_db = false\n").string();
    CHECK(compared(folder, reference + " " + (folder.path / "c.wav").string() + " --thresholds " + forgiving,
                   0)["verdict"] == "pass");
}

TEST_CASE("a person reads the verdict first, then why, and a figure is written as its name says") {
    const Folder folder;
    const std::string a = sound_of(folder, "a.wav", saw(233.0)).string(),
                      b = sound_of(folder, "b.wav", saw(150.0)).string();
    const std::string svg = (folder.path / "f.svg").string(), png = (folder.path / "f.png").string();
    const Outcome text = folder.tactus("compare " + a + " " + b + " --plot " + svg);
    CHECK(text.code == 1);
    CHECK(text.out.starts_with("FAIL: "));
    std::smatch failed;
    REQUIRE(std::regex_search(text.out, failed, std::regex("\\n +FAIL +lsd_db ")));
    CHECK(text.out.find("150.00 Hz in the output", static_cast<std::size_t>(failed.position())) != std::string::npos);
    CHECK(slurp(svg).starts_with("<svg"));
    CHECK(slurp(svg).find("Not the same vibration") != std::string::npos);
    CHECK(folder.tactus("compare " + a + " " + a + " --plot " + png).code == 0);
    CHECK(slurp(png).substr(1, 3) == "PNG");
    CHECK(folder.tactus("compare " + a + " " + a + " --plot f.gif").code == 2);
}

TEST_CASE("a report is one page that needs nothing else and names what it found", "[slow]") {
    const Folder folder;
    const std::string a = sound_of(folder, "a.wav", saw(233.0)).string();
    const auto hummed = [tone = saw(233.0)](double t) mutable {
        return tone(t) + 0.2 * std::sin(2.0 * std::numbers::pi * 50.0 * t);
    };
    const std::string b = sound_of(folder, "b&c.wav", hummed).string();
    const fs::path page = folder.path / "page.html";
    CHECK(folder.tactus("compare " + a + " '" + b + "' --report " + page.string()).code == 1);
    const std::string html = slurp(page);
    for (const char* needed : {"<!doctype html>", "<svg", "limit of touch", "Not the same vibration", "b&amp;c.wav",
                               "mains hum, 50 Hz", "order 2", "only in the output", "lsd_db", "Methods"}) {
        INFO(needed);
        CHECK(html.find(needed) != std::string::npos);
    }
    CHECK(html.find("b&c.wav") == std::string::npos);
    // Nothing is fetched.
    for (const char* reference : {"src=", "@import", "<script", "<link"}) {
        INFO(reference);
        CHECK(html.find(reference) == std::string::npos);
    }
    for (std::size_t at = html.find("href="); at != std::string::npos; at = html.find("href=", at + 1))
        CHECK(html.substr(at, 11) == "href=\"data:");
    // Aligned takes have coherence; those of two recordings say that they have none.
    CHECK(html.find("One recording") != std::string::npos);
    const std::string other = sound_of(folder, "other.wav", saw(233.4, 0.3, 77)).string();
    const fs::path second = folder.path / "second.html";
    CHECK(folder.tactus("compare " + a + " " + other + " --report " + second.string()).code != 2);
    CHECK(slurp(second).find("Two recordings") != std::string::npos);
    CHECK(folder.tactus("compare " + a + " " + a + " --report /nowhere/page.html").code == 2);
}

TEST_CASE("saws at an order of the mains are compared at equal orders, and what may be hum is reported as such") {
    const Folder folder;
    const SoundShape shape{.rate = 8000, .seconds = 8.0};
    const auto orders = [](double hz, int count, std::uint64_t seed) {
        return [=, state = seed](double t) mutable {
            state = state * 6364136223846793005ULL + 1442695040888963407ULL;
            double sum = 0.02 * (static_cast<double>(state >> 11) * 0x1.0p-53 - 0.5);
            for (int k = 1; k <= count; ++k) sum += std::sin(2.0 * std::numbers::pi * k * hz * t + k * k) / k;
            return 0.3 * sum;
        };
    };
    const std::string saw = sound_of(folder, "saw.wav", orders(100.0, 7, 1), shape).string(),
                      faster = sound_of(folder, "faster.wav", orders(100.7, 7, 2), shape).string(),
                      few = sound_of(folder, "few.wav", orders(100.0, 3, 3), shape).string(),
                      again = sound_of(folder, "again.wav", orders(100.0, 3, 4), shape).string();
    const Outcome same = folder.tactus("compare " + saw + " " + faster);
    CAPTURE(same.out);
    CHECK(same.code == 0);
    CHECK(same.out.find("100.00 Hz in the reference, 100.70 Hz in the output; compared at equal orders") !=
          std::string::npos);
    CHECK(same.out.find("mains hum") == std::string::npos);
    const Outcome hum = folder.tactus("compare " + few + " " + again);
    CAPTURE(hum.out);
    CHECK(hum.out.find("100.00 Hz in the reference (or mains hum: not used)") != std::string::npos);
    CHECK(hum.out.find("is an order of the mains, mains hum or a machine") != std::string::npos);
    CHECK(hum.out.find("order 2 of 100 Hz, or mains hum") != std::string::npos);
    const Outcome one = folder.tactus("spectrum " + few);
    CAPTURE(one.out);
    CHECK(one.out.find("uncertain: it may be mains hum") != std::string::npos);
    CHECK(one.out.find("a record with the machine off shows the hum") != std::string::npos);
    const std::string page = (folder.path / "few.html").string();
    REQUIRE(folder.tactus("spectrum " + few + " --quiet -o " + page).code == 0);
    CHECK(slurp(page).find("order 2 of 100 Hz, or mains hum") != std::string::npos);
    CHECK(folder.tactus("spectrum " + saw).out.find("uncertain: it may be mains hum") != std::string::npos);
    CHECK(folder.tactus("spectrum " + faster).out.find("uncertain") == std::string::npos);
}

TEST_CASE("compare answers or says what is wrong with a file, once, and ends with exit code 2", "[slow]") {
    const Folder folder;
    const std::string good = sound_of(folder, "good.wav", saw(233.0)).string();
    const auto against = [&](const fs::path& file) { return folder.tactus("compare " + good + " " + file.string()); };
    const auto refused = [&](const fs::path& file, const std::string& why) {
        const Outcome outcome = against(file);
        INFO(file << ": " << outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.out.empty());
        CHECK(outcome.err.find(why) != std::string::npos);
        CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    };
    refused(folder.path / "none.wav", "no such sound file");
    refused(folder.write("empty.wav", ""), "cannot be read as sound");
    refused(folder.write("text.wav", std::string(1000, 'x')), "cannot be read as sound");
    fs::create_directories(folder.path / "bare");
    refused(folder.path / "bare", "folder");
    refused(sound_of(folder, "silent.wav", [](double) { return 0.0; }), "output is silent");
    refused(sound_of(folder, "constant.wav", [](double) { return 0.5; }), "output is silent");
    refused(sound_of(folder, "one.wav", saw(233.0), {.seconds = 1.0 / 48000.0}), "shorter than 0.5 s");
    refused(
        sound_of(folder, "nan.wav", [](double t) { return t > 1.0 ? std::numeric_limits<double>::quiet_NaN() : 0.1; }),
        "NaN");
    refused(sound_of(folder, "slow.wav", saw(30.0), {.rate = 160}), "trusted to 72 Hz only");
    const std::string bytes = slurp(good);
    refused(folder.write("cut.wav", bytes.substr(0, 40)), "cannot be read as sound");

    const auto passes = [&](const fs::path& file) {
        INFO(file);
        CHECK(against(file).code == 0);
    };
    passes(sound_of(folder, "loud.wav", saw(233.0, 5.0, 3)));
    passes(sound_of(folder, "u8.wav", saw(233.0, 0.4, 3), {.format = SF_FORMAT_WAV | SF_FORMAT_PCM_U8}));
    passes(sound_of(folder, "b24.flac", saw(233.0, 0.3, 3), {.format = SF_FORMAT_FLAC | SF_FORMAT_PCM_24}));
    passes(sound_of(folder, "w64.w64", saw(233.0, 0.3, 3), {.format = SF_FORMAT_W64 | SF_FORMAT_FLOAT}));
    passes(sound_of(folder, "k192.wav", saw(233.0, 0.3, 3), {.rate = 192000}));
    passes(sound_of(folder, "k3.wav", saw(233.0, 0.3, 3), {.rate = 3000}));
    passes(sound_of(folder, "seven.wav",
                    [s = saw(233.0, 0.3, 3), value = 0.0, channel = 0](double t) mutable {
                        if (channel++ % 7 == 0) value = s(t);
                        return value;
                    },
                    {.channels = 7}));
    const Outcome clipped = against(sound_of(
        folder, "clipped.wav", [s = saw(233.0)](double t) mutable { return std::clamp(3.0 * s(t), -1.0, 1.0); }));
    CHECK(clipped.code != 2);
    CHECK(clipped.out.find("clipped") != std::string::npos);
}

TEST_CASE("compare reads logs as it reads sounds, each with its own columns, and the longest piece between gaps",
          "[slow]") {
    const Folder folder;
    // 2.5 kHz with jitter; one column is the vibration, one is not.
    const auto log = [&](const char* name, const char* header, double from, double to, double gap) {
        std::string text = header;
        double t = from;
        for (int i = 0; t < to; ++i) {
            t = from + 0.4e-3 * i + (i % 3 == 0 ? 0.02e-3 : 0.0) + (i >= 2000 ? gap : 0.0);
            double y = 0.0;  // 120 Hz might be hum of the mains
            for (int k = 1; k <= 3; ++k) y += std::sin(2.0 * std::numbers::pi * k * 110.0 * t + k * k) / k;
            text += std::to_string(1e3 * t) + "," + std::to_string(i % 2) + "," + std::to_string(y) + "\n";
        }
        return folder.write(name, text).string();
    };
    const std::string whole = log("a.csv", "time_ms,flag,accel\n", 0.0, 6.0, 0.0);
    const std::string parted = log("b.csv", "when_ms,flag,value\n", 1.0, 9.0, 0.5);
    const std::string wave = sound_of(folder, "a.wav",
                                      [](double t) {
                                          double y = 0.0;
                                          for (int k = 1; k <= 3; ++k)
                                              y += 0.3 * std::sin(2.0 * std::numbers::pi * k * 110.0 * t + k * k) / k;
                                          return y;
                                      },
                                      {.seconds = 5.0})
                                 .string();
    const json same = compared(folder, whole + " " + wave + " --time-column time_ms --column accel", 0);
    CHECK(same["fundamental_hz"]["reference"].get<double>() == Approx(110.0).margin(0.1));
    const json both = compared(
        folder, whole + " " + parted + " --time-column time_ms,when_ms --column accel,value --time-unit ms", 0);
    CHECK(both["notes"].dump().find("only the longest of its 2 parts is compared") != std::string::npos);
    const Outcome none = folder.tactus("compare " + whole + " " + wave + " --column nothing");
    CHECK(none.code == 2);
    CHECK(none.err.find("nothing") != std::string::npos);
    // The column of only one file.
    const Outcome one = folder.tactus("compare " + whole + " " + parted + " --time-unit ms --column accel");
    CHECK(one.code == 2);
    CHECK(one.err.find("b.csv:1:1: there is no column 'accel'; there are when_ms, flag, value; names that differ "
                       "between the files are stated as REFERENCE,OUTPUT") != std::string::npos);
    const std::string quoted = log("c.csv", "time_ms,flag,\"acc, x (m/s^2)\"\n", 0.0, 6.0, 0.0);
    compared(folder, whole + " " + quoted + " --column 'accel,\"acc, x (m/s^2)\"'", 0);
    compared(folder, quoted + " " + quoted + " --column 'acc, x'", 0);
    const Outcome spectrum = folder.tactus("spectrum " + quoted + " --column 'acc, x (m/s^2)'");
    CHECK(spectrum.code == 0);
    CAPTURE(spectrum.err);
}

TEST_CASE("a chain saw is not the same as silence, and each score says in which band it was judged") {
    const char* const data = std::getenv("TACTUS_SHARED_DATA");
    if (!data) {
        tactus::test::skip("needs recordings in TACTUS_SHARED_DATA");
        return;
    }
    const Folder folder;
    const std::string saw = fmt::format("{}/recordings/accel_tree_chainsaw.csv", data),
                      silence = fmt::format("{}/recordings/accel_tree_ambient.csv", data);
    const json axis = compared(folder, saw + " " + silence + " --column accel_z", 1);
    CHECK(axis["failed"].dump().find("above_noise") != std::string::npos);
    CHECK(axis["above_noise"]["both_hz"].empty());
    CHECK(axis["above_noise"]["output"] == 0);
    CHECK(axis["band_hz"][1].get<double>() == Approx(100.0).margin(0.5));
    for (const json& score : axis["scores"]) CHECK(score["band_hz"] == axis["band_hz"]);
    const Outcome text = folder.tactus("compare " + saw + " " + silence);
    CHECK(text.code == 1);
    CHECK(text.out.find("40 to 100 Hz") != std::string::npos);
    CHECK(text.out.find("500 Hz") == std::string::npos);
    CHECK(text.out.find("compared: channel accel_x of the reference, its strongest") != std::string::npos);
    const json vector = compared(folder, saw + " " + silence + " --axes vector", 1);
    CHECK(vector["notes"].dump().find("root sum of squares of 3 channels") != std::string::npos);
    CHECK(folder.tactus("compare " + saw + " " + saw).code == 0);
}

TEST_CASE("compare refuses a log that can be trusted to 42 Hz only") {
    const Folder folder;
    std::string text = "time_ms,a\n";
    for (int i = 0; i < 4000; ++i)  // every 50th step is four times as long
        text += fmt::format("{},{:.6f}\n", 3 * i + 9 * (i / 50),
                            std::sin(2.0 * std::numbers::pi * 0.06 * (3 * i + 9 * (i / 50))));
    const std::string log = folder.write("log.csv", text).string();
    const Outcome refused = folder.tactus("compare " + log + " " + log);
    CHECK(refused.code == 2);
    CHECK(refused.err.find("can be trusted to 41.7 Hz only") != std::string::npos);
}

TEST_CASE("of several channels the strongest of the reference is compared with the same of the output") {
    const Folder folder;
    const auto file = [&](const char* name, double first, double second) {
        return sound_of(folder, name,
                        [=, a = saw(233.0, first), b = saw(150.0, second), channel = 0](double t) mutable {
                            return channel++ % 2 == 0 ? a(t) : b(t);
                        },
                        {.channels = 2})
            .string();
    };
    const std::string reference = file("a.wav", 0.1, 0.5), output = file("b.wav", 0.5, 0.2);
    const json same = compared(folder, reference + " " + output, 0);
    CHECK(same["fundamental_hz"]["reference"].get<double>() == Approx(150.0).margin(0.1));
    CHECK(same["fundamental_hz"]["output"].get<double>() == Approx(150.0).margin(0.1));
    CHECK(compared(folder, reference + " " + output + " --channel 1", 0)["fundamental_hz"]["output"].get<double>() ==
          Approx(233.0).margin(0.1));
    CHECK(compared(folder, reference + " " + output + " --axes vector", 1)["verdict"] == "fail");
    const std::string mono = sound_of(folder, "m.wav", saw(150.0)).string();
    CHECK(folder.tactus("compare " + reference + " " + mono).code == 0);
    CHECK(folder.tactus("compare " + reference + " " + mono + " --axes vector").code == 2);
}

// Costly: a recording of more than 5 min.
TEST_CASE("compare needs no more memory for a longer recording", "[slow]") {
    if (tactus::test::sanitized) return tactus::test::skip("sanitizers hold memory of their own");
    const Folder folder;
    const auto kilobytes = [&](double seconds) {
        const fs::path file = sound_of(folder, "long.wav", saw(233.0), {.rate = 8000, .seconds = seconds});
        const auto peak = tactus::test::peak_memory({"compare", file.string(), file.string()});
        CHECK(peak.code == 0);
        return peak.kilobytes;
    };
    // A minute is held, for the alignment; 240 s would take 15 MB more per copy of the samples.
    CHECK(kilobytes(330.0) < kilobytes(90.0) + 8000);
}

TEST_CASE("a log of a million lines takes a fraction of the memory of its numbers as double and text", "[slow]") {
    if (tactus::test::sanitized) return tactus::test::skip("sanitizers hold memory of their own");
    const Folder folder;
    const auto kilobytes = [&](int rows) {
        std::string text = "a\n";
        for (int n = 0; n < rows; ++n) text += fmt::format("{:.5f}\n", 1.5 * std::sin(0.0785398 * n));
        const auto peak =
            tactus::test::peak_memory({"spectrum", folder.write("long.csv", text).string(), "--sample-rate", "10 kHz"});
        CHECK(peak.code == 0);
        return peak.kilobytes;
    };
    // 4 bytes a row, and 8 for the even record, which is kept up to 64 MB. With text and doubles it was 119.
    CHECK(kilobytes(1'300'000) - kilobytes(300'000) < 30'000);
}

TEST_CASE("measure and equalise refuse what makes no sense with one line", "[slow]") {
    const Folder folder;
    const std::string table = folder.write("t.csv", "20 0\n100 0\n2000 0\n").string();
    const std::pair<std::string, std::string> slips[] = {
        {"measure", "--device"},
        {"measure saw-vibration", "--in NODE.PORT"},
        {"measure saw-vibration --in actuator --probe handle.out", "NODE.PORT"},
        {"measure saw-vibration --in actuator.driv --probe handle.out", "did you mean 'drive'?"},
        {"measure saw-vibration --in actuatr.drive --probe handle.out", "did you mean 'actuator'?"},
        {"measure saw-vibration --in actuator.drive --probe actuator.drive", "is an input"},
        {"measure saw-vibration --in felt.in --probe saw.signal", "no signal 'in'"},
        {"measure saw-vibration --in handle.in --probe handle.out", "leads to several ports"},
        {"measure saw-vibration --in speaker.signal --probe handle.out", "no wires lead"},
        {"measure saw-vibration --in actuator.drive --probe handle.out --band 20:30000", "half the node's rate"},
        {"measure saw-vibration --in actuator.drive --probe handle.out --band 50:20", "LOW:HIGH"},
        {"measure none --in a.b --probe c.d", "no patch 'none'"},
        {"equalise " + (folder.path / "none.csv").string() + " -o f.toml", "none.csv"},
        {"equalise " + folder.write("x.csv", "1 2\n").string() + " -o f.toml", "3 frequencies"},
        {"equalise " + table + " -o f.toml --actuator none", "known are"},
        {"equalise " + table + " -o f.toml --band 5:400", "covers"},
        {"equalise " + table + " -o f.toml --rate 100", "too low"},
        {"equalise " + table + " -o /nowhere/f.toml", "/nowhere"},
    };
    for (const auto& [arguments, why] : slips) {
        const Outcome outcome = folder.tactus(arguments);
        INFO(arguments << ": " << outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find(why) != std::string::npos);
    }
}

TEST_CASE("equalise says how much of a recording the actuator's limits cut", "[slow]") {
    const Folder folder;
    const std::string table = folder.write("t.csv", "20 0\n100 0\n200 0\n2000 0\n").string();
    const std::string take = sound_of(folder, "a.wav", saw(233.0, 0.5)).string();
    const auto headroom = [&](const char* volts) {
        const Outcome made = folder.tactus("equalise " + table + " --json --signal " + take + " --volts " + volts +
                                           " -o " + (folder.path / "f.toml").string());
        INFO(made.err);
        REQUIRE(made.code == 0);
        return json::parse(made.out)["headroom"]["after"];
    };
    const json quiet = headroom("1"), loud = headroom("10");
    CHECK(quiet["headroom_db"] > 0.0);
    CHECK(quiet["limited_fraction"] == 0.0);
    CHECK(loud["headroom_db"].get<double>() == Approx(quiet["headroom_db"].get<double>() - 20.0).margin(0.01));
    CHECK(loud["limited_fraction"] > 0.05);
    CHECK(loud["lost"].size() >= 1);
}
