// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/verdict.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;
using namespace tactus::analysis;

namespace {

/// Of that amplitude in dB.
signal::SpectralLine line(double hz, double db) { return {hz, 0.5 * std::pow(10.0, db / 10.0), 20.0}; }

signal::Comparison good() {
    signal::Comparison c;
    c.cosine_500 = c.cosine_1000 = 1.0;
    c.reference_rms = c.output_rms = 1.0;
    c.harmonic_error_db = 0.1;
    c.lines.in_both = {line(200.0, 0.0)};
    c.above_noise = {1, 1, {200.0}};
    return c;
}

}  // namespace

TEST_CASE("a comparison passes when every score reaches its threshold and fails by the names of those that do not") {
    CHECK(judge(good(), 30.0, {}).passed());
    signal::Comparison c = good();
    c.lsd_db = 2.1;
    c.cosine_1000 = 0.9;
    CHECK(judge(c, 0.0, {}).failed() == std::vector<std::string>{"lsd_db", "cosine_40_1000"});
    table::Thresholds levelled;
    levelled.level_gap_db = 10.0;
    CHECK(judge(good(), 10.0, levelled).passed());
    CHECK(judge(good(), 10.1, levelled).failed() == std::vector<std::string>{"level_gap_db"});
}

TEST_CASE("a score that does not exist is not judged, and said to be so") {
    signal::Comparison c = good();
    c.harmonic_error_db.reset();
    table::Thresholds strict;
    strict.st_sim = 0.9;
    const Verdict verdict = judge(c, 0.0, strict);
    CHECK(verdict.passed());
    CHECK(verdict.not_judged == std::vector<std::string>{"harmonic_error_db", "st_sim"});
}

TEST_CASE("without anything above the noise of both there is no pass, and scores name the band that they judge") {
    signal::Comparison c = good();
    c.above_noise.in_both.clear();
    CHECK(judge(c, 0.0, {}).failed() == std::vector<std::string>{"above_noise"});
    CHECK_FALSE(judge(c, 0.0, {}).is_judged());
    CHECK(judge(c, 0.0, {}).words().starts_with("Cannot be judged, 40 to 1000 Hz"));
    signal::Comparison other = c;
    other.lsd_db = 20.0;
    CHECK(judge(other, 0.0, {}).words() == "Not the same vibration, 40 to 1000 Hz");
    c.alignment.significant = true;
    c.coherence_mean = 0.9;  // what two takes of one event share is no noise
    CHECK(judge(c, 0.0, {}).passed());
    c.highest = 150.0;
    const Verdict narrow = judge(c, 0.0, {});
    CHECK(narrow.not_judged == std::vector<std::string>{"cosine_40_1000"});
    for (const Judged& score : narrow.scores) {
        INFO(score.about);
        CHECK(score.about.ends_with("40 to 150 Hz"));
    }
}

TEST_CASE("a line that only one has counts by its level beside the reference's strongest, at equal power") {
    signal::Comparison c = good();
    c.gain_db = 20.0;
    c.lines.only_in_output = {line(50.0, -49.0)};  // −29 dB with the gain
    CHECK(judge(c, 0.0, {}).failed() == std::vector<std::string>{"only_in_output"});
    c.lines.only_in_output = {line(50.0, -51.0)};
    CHECK(judge(c, 0.0, {}).passed());
    c.lines.only_in_reference = {line(400.0, -19.0)};
    CHECK(judge(c, 0.0, {}).failed() == std::vector<std::string>{"only_in_reference"});
    c.lines.only_in_reference = {line(400.0, -21.0)};
    CHECK(judge(c, 0.0, {}).passed());
}

TEST_CASE("a line is named after the saw's order first, then after the mains") {
    const RecordRates saw{233.0, 0.0, signal::MainsComb{50, 49.87, 0.01, 3}};
    CHECK(saw.name_of(466.1) == "order 2");
    CHECK(saw.name_of(49.9) == "mains hum, 50 Hz");
    CHECK(saw.name_of(149.6) == "mains hum, 3 × 50 Hz");
    CHECK(saw.name_of(150.3).empty());
    CHECK(saw.name_of(77.0).empty());
    CHECK(RecordRates{50.0, 0.0, signal::MainsComb{50, 50.0, 0.01, 3}}.name_of(100.0) == "order 2");
    CHECK(RecordRates{}.name_of(100.0).empty());
}

TEST_CASE("a line that may be hum or a machine's is named as both") {
    CHECK(RecordRates{0.0, 99.8, signal::MainsComb{50, 49.9, 0.01, 2}}.name_of(199.6) ==
          "order 2 of 99.8 Hz, or mains hum");
    CHECK(RecordRates{0.0, 0.0, signal::MainsComb{60, 60.0, 0.01, 2}}.name_of(180.0) ==
          "order 3 of 60 Hz, or mains hum");
    signal::Comparison c = good();
    c.reference_hz = 51.0, c.output_hum_hz = 50.0;
    c.lines.only_in_output = {line(50.0, -20.0), line(150.0, -20.0)};
    CHECK(LineNames(c).of_output(150.0) == "order 3 of 50 Hz, or mains hum");
    CHECK(LineNames(c).of_reference(153.0) == "order 3");
}

TEST_CASE("the lines of one record are hum of one mains, within the range of its frequency") {
    signal::Comparison c = good();
    c.reference_hz = c.output_hz = 233.0;
    for (const double hz : {100.0, 200.0, 300.0, 400.0, 500.0, 600.0})
        c.lines.only_in_reference.push_back(line(hz, -20.0));
    c.lines.only_in_output = {line(99.6, -20.0), line(199.2, -20.0), line(151.2, -20.0), line(900.0, -20.0)};
    const LineNames names(c);
    CHECK(names.of_reference(100.0) == "mains hum, 2 × 50 Hz");
    CHECK(names.of_reference(600.0) == "mains hum, 12 × 50 Hz");
    CHECK(names.of_output(199.2) == "mains hum, 4 × 50 Hz");
    for (const double hz : {151.2, 900.0}) CHECK(names.of_output(hz).empty());
    CHECK(mains_of(std::vector{line(60.02, -30.0), line(180.0, -30.0), line(300.0, -30.0)}, 0.0)->nominal == 60);
    CHECK_FALSE(mains_of(std::vector{line(400.0, -30.0)}, 0.0));
    // Sources of hum have no family of orders 3, 6, 9.
    CHECK_FALSE(mains_of(std::vector{line(150.0, -30.0), line(300.0, -30.0), line(450.0, -30.0)}, 0.0));
}

TEST_CASE("lines off the frequency of the mains that the other lines show are no hum") {
    signal::Comparison c = good();
    c.reference_hz = c.output_hz = 233.0;
    c.lines.in_both = {line(466.0, 0.0)};
    // Within 0.5 % of its orders, but no orders of 49.9 Hz.
    const std::vector<double> beside{251.0, 350.9, 448.1};
    for (const double hz : {49.9, 99.8, 299.4}) c.lines.only_in_output.push_back(line(hz, -20.0));
    for (const double hz : beside) c.lines.only_in_output.push_back(line(hz, -10.0));
    const LineNames names(c);
    CHECK(names.of_output(49.9) == "mains hum, 50 Hz");
    CHECK(names.of_output(299.4) == "mains hum, 6 × 50 Hz");
    for (const double hz : beside) CHECK(names.of_output(hz).empty());
    // A machine at the mains does not draw the hum beside it to its rate.
    const std::vector<signal::SpectralLine> both{line(49.97, -30.0), line(100.4, 0.0), line(149.91, -30.0),
                                                 line(200.8, 0.0), line(301.2, 0.0)};
    CHECK(mains_of(both, 100.4)->frequency == Approx(49.97).margin(0.01));
}
