// SPDX-License-Identifier: Apache-2.0
// Figures of several records, marks, plotted ranges, numbers as people read them.
#include "tests/support/catch.hpp"
#include "tests/tools/record_folder.hpp"

#include <algorithm>
#include <string>
#include <vector>

using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using tactus::test::add_noise;
using tactus::test::RecordFolder;
using tactus::test::RecordOutcome;
using tactus::test::slurp;
using tactus::test::tones;

namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// A carrier of 3 kHz whose amplitude swings by a half at 118.9 Hz: the envelope of its band has that line.
std::vector<double> bearing() {
    std::vector<double> x = tones({{3000.0, 0.4}, {3118.9, 0.1}, {2881.1, 0.1}, {30.0, 0.2}}, 8.0, 16000.0);
    add_noise(x, 0.002);
    // sin·(1 + m·cos): both sides are half of m times the carrier, in phase with it.
    return x;
}

}  // namespace

TEST_CASE("several records are drawn in one figure, each with its name and colour") {
    const RecordFolder folder;
    folder.sound("first.wav", tones({{100.0, 0.5}}, 2.0, 8000.0), 1, 8000);
    folder.sound("second.wav", tones({{200.0, 0.5}}, 2.0), 1);
    folder.sound("third.wav", tones({{300.0, 0.5}}, 2.0, 8000.0), 1, 8000);
    REQUIRE(folder.tactus("spectrum first.wav second.wav third.wav --plot all.svg").code == 0);
    const std::string figure = slurp(folder.path / "all.svg");
    for (const char* part : {"first.wav", "second.wav", "third.wav", "dB re (full scale)²/Hz", "frequency, Hz"})
        CHECK_THAT(figure, ContainsSubstring(part));
    // One plot: one axis, a legend line and a curve in each colour.
    CHECK(count_of(figure, "frequency, Hz") == 1);
    for (const char* colour : {"#0072B2", "#D55E00", "#009E73"}) {
        std::string lower = colour;
        std::ranges::transform(lower, lower.begin(),
                               [](char c) { return c >= 'A' && c <= 'F' ? static_cast<char>(c + 32) : c; });
        CAPTURE(colour);
        CHECK(count_of(figure, colour) + count_of(figure, lower) >= 2);
    }
    REQUIRE(folder.tactus("spectrum first.wav second.wav --plot all.png").code == 0);
    CHECK(slurp(folder.path / "all.png").starts_with("\x89PNG"));
    REQUIRE(folder.tactus("spectrum first.wav second.wav --plot each").code == 0);
    CHECK(std::filesystem::exists(folder.path / "each/second.wav.svg"));
}

TEST_CASE("records in different units are not drawn on one axis") {
    const RecordFolder folder;
    folder.sound("sound.wav", tones({{100.0, 0.5}}, 2.0, 8000.0), 1, 8000);
    std::string text = "time_s,a\n";
    for (int i = 0; i < 4000; ++i) text += fmt::format("{},{}\n", 0.001 * i, std::sin(0.3 * i));
    folder.text("log.csv", text);
    const RecordOutcome outcome = folder.tactus("spectrum sound.wav log.csv --plot all.svg");
    CHECK(outcome.code == 2);
    CHECK_THAT(outcome.err, ContainsSubstring("sound.wav is in full scale and log.csv in count"));
    CHECK_FALSE(std::filesystem::exists(folder.path / "all.svg"));
    CHECK(folder.tactus("spectrum --calibration '1 m/s^2' sound.wav log.csv --plot all.svg").code == 0);
    folder.sound("wide.wav", std::vector<double>(8000 * 15, 0.1), 15, 8000);
    CHECK_THAT(folder.tactus("spectrum sound.wav wide.wav --plot many.svg").err,
               ContainsSubstring("16 channels: one figure holds at most 14"));
}

TEST_CASE("a mark states the level of the spectrum and of the envelope at its frequency, and the nearest line") {
    const RecordFolder folder;
    folder.sound("bearing.wav", bearing(), 1, 16000);
    const RecordOutcome outcome = folder.tactus(
        "spectrum --json bearing.wav --envelope 2500:3500 --mark '118.9 Hz:BPFI:2' --mark 30:shaft --mark 9000:none "
        "--plot marked.svg");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json marks = outcome.only("rows")["channels"][0]["marks"];
    REQUIRE(marks.size() == 4);
    CHECK(marks[0]["label"] == "BPFI");
    CHECK(marks[0]["hz"] == 118.9);
    // The amplitude of the envelope swings by 0.2: rms 0.2/√2.
    const json& envelope = marks[0]["envelope"];
    CHECK(envelope["is_line"] == true);
    CHECK(envelope["hz"].get<double>() == Approx(118.9).margin(0.05));
    CHECK(envelope["rms"].get<double>() == Approx(0.2 / std::numbers::sqrt2).epsilon(0.02));
    CHECK(envelope["rms_db"].get<double>() == Approx(20.0 * std::log10(0.2 / std::numbers::sqrt2)).margin(0.2));
    CHECK(envelope["nearest_line"]["offset_hz"].get<double>() == Approx(0.0).margin(0.05));
    // The spectrum itself has nothing there: the nearest line is the shaft.
    CHECK(marks[0]["spectrum"]["is_line"] == false);
    CHECK(marks[0]["spectrum"]["nearest_line"]["hz"].get<double>() == Approx(30.0).margin(0.05));
    CHECK(marks[0]["spectrum"]["nearest_line"]["offset_hz"].get<double>() == Approx(30.0 - 118.9).margin(0.05));
    CHECK(marks[1]["harmonic"] == 2);
    CHECK(marks[1]["hz"] == 237.8);
    CHECK(marks[2]["spectrum"]["rms"].get<double>() == Approx(0.2 / std::numbers::sqrt2).epsilon(0.005));
    CHECK(marks[2]["spectrum"]["is_line"] == true);
    CHECK(marks[3]["spectrum"].is_null());
    const std::string figure = slurp(folder.path / "marked.svg");
    CHECK(count_of(figure, ">BPFI<") == 2);  // in the spectrum and in the envelope
    CHECK(count_of(figure, ">BPFI ×2<") == 2);
    CHECK_THAT(figure, ContainsSubstring("envelope of 2.5 kHz to 3.5 kHz"));
    const std::string text = folder.tactus("spectrum bearing.wav --envelope 2500:3500 --mark 118.9:BPFI").out;
    CHECK_THAT(text, ContainsSubstring("BPFI at 118.90 Hz of the envelope: -17.0 dB rms at 118.90 Hz"));
    CHECK_THAT(text, ContainsSubstring("BPFI at 118.90 Hz: no line"));
    for (const char* mark : {"118.9", "x:BPFI", "118.9:", "-3:a", "118.9:a:0", "118.9:a:1000", "'3 kg:a'"}) {
        CAPTURE(mark);
        CHECK(folder.tactus(fmt::format("spectrum bearing.wav --mark {}", mark)).code == 2);
    }
}

TEST_CASE("a plot goes to half the sample rate, or over the band that is asked for") {
    const RecordFolder folder;
    std::vector<double> x = tones({{100.0, 0.3}, {15000.0, 0.2}}, 2.0);
    add_noise(x, 0.01);
    folder.sound("a.wav", x);
    REQUIRE(folder.tactus("spectrum a.wav --plot whole.svg").code == 0);
    CHECK_THAT(slurp(folder.path / "whole.svg"), ContainsSubstring(">20k<"));
    REQUIRE(folder.tactus("spectrum a.wav --plot part.svg --band '50 Hz:2 kHz'").code == 0);
    const std::string part = slurp(folder.path / "part.svg");
    CHECK_THAT(part, ContainsSubstring(">2k<"));
    CHECK_THAT(part, !ContainsSubstring(">5k<"));
    const RecordOutcome beyond = folder.tactus("spectrum a.wav --plot no.svg --band 30000:40000");
    CHECK(beyond.code == 2);
    CHECK_THAT(beyond.err, ContainsSubstring("ends at 24 kHz"));
}

TEST_CASE("text and pages write numbers without exponents") {
    const RecordFolder folder;
    std::vector<double> x = tones({{100.0, 2e-5}, {12000.0, 1e-5}}, 3.0, 96000.0);
    add_noise(x, 1e-6);
    folder.sound("quiet.wav", x, 1, 96000);
    const RecordOutcome outcome = folder.tactus(
        "spectrum quiet.wav --full-scale '49 m/s^2' --report page.html --plot a.svg --envelope 10000:20000");
    REQUIRE(outcome.code == 0);
    CHECK_THAT(outcome.out, ContainsSubstring("3.000 s at 96 kHz"));
    CHECK_THAT(outcome.out, ContainsSubstring("µm/s^2"));
    const std::string orders = folder.tactus("orders --rate 100 quiet.wav").out,
                      exposure = folder.tactus("exposure --full-scale '49 m/s^2' quiet.wav").out;
    const std::string page = slurp(folder.path / "page.html");
    CHECK_THAT(page, ContainsSubstring(">12589<"));
    for (const std::string* text : {&outcome.out, &page, &orders, &exposure}) {
        const std::size_t at = std::min(text->find("e+0"), text->find("e-0"));
        CAPTURE(at == std::string::npos ? std::string() : text->substr(at > 40 ? at - 40 : 0, 60));
        CHECK(at == std::string::npos);
    }
}

TEST_CASE(
    "the figure of a comparison goes beyond the judged band, which it shows, or over the band that is asked for") {
    const RecordFolder folder;
    std::vector<double> x = tones({{100.0, 0.3}, {2500.0, 0.2}}, 2.0);
    add_noise(x, 0.01);
    folder.sound("a.wav", x);
    REQUIRE(folder.tactus("compare a.wav a.wav --plot whole.svg").code == 0);
    const std::string whole = slurp(folder.path / "whole.svg");
    CHECK_THAT(whole, ContainsSubstring(">2k<"));
    CHECK_THAT(whole, ContainsSubstring(">not judged"));
    REQUIRE(folder.tactus("compare a.wav a.wav --plot part.svg --band 40:1000").code == 0);
    const std::string part = slurp(folder.path / "part.svg");
    CHECK_THAT(part, !ContainsSubstring(">2k<"));
    CHECK_THAT(part, !ContainsSubstring(">not judged"));
    const RecordOutcome beyond = folder.tactus("compare a.wav a.wav --plot no.svg --band 5000:6000");
    CHECK(beyond.code == 2);
    CHECK_THAT(beyond.err, ContainsSubstring("end at 4 kHz"));
}

TEST_CASE("figures in the style of a journal are 85 mm wide, and no text is below 6 points or outside of them") {
    const RecordFolder folder;
    std::vector<double> both;
    for (const double v : tones({{100.0, 0.4}, {200.0, 0.1}}, 2.0, 4000.0)) {
        both.push_back(v);
        both.push_back(0.5 * v);
    }
    folder.sound("a.wav", both, 2, 4000);
    std::vector<double> faster;  // from 100 to 140 Hz
    for (int i = 0; i < 16000; ++i) {
        const double t = i / 4000.0, turns = 100.0 * t + 5.0 * t * t;
        faster.push_back(0.4 * std::sin(2.0 * std::numbers::pi * turns) +
                         0.2 * std::sin(4.0 * std::numbers::pi * turns));
    }
    folder.sound("faster.wav", faster, 1, 4000);
    for (const char* command : {"response a.wav", "orders a.wav --rate 100 --waterfall w.csv --over frequency",
                                "orders faster.wav --band 80:160 --waterfall w.csv --against speed"}) {
        CAPTURE(command);
        REQUIRE(folder.tactus(fmt::format("{} --quiet --style journal -o f.svg -o f.png", command)).code == 0);
        const std::string svg = slurp(folder.path / "f.svg");
        const double width = std::stod(svg.substr(svg.find("width=\"") + 7));
        CHECK(width == Approx(85.0 / 25.4 * 96.0).margin(0.5));
        int texts = 0;
        for (std::size_t at = svg.find("<text"); at != std::string::npos; at = svg.find("<text", at + 1)) {
            const double size = std::stod(svg.substr(svg.find("font-size=\"", at) + 11)),
                         x = std::stod(svg.substr(svg.find("x=\"", at) + 3));
            CHECK(size >= 8.0 - 1e-6);
            CHECK(x >= 0.0);
            CHECK(x <= width);
            ++texts;
        }
        CHECK(texts > 10);
    }
    CHECK(folder.tactus("response a.wav --style poster").code == 2);
}
