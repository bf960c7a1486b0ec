// SPDX-License-Identifier: Apache-2.0
// --from and --to in every verb that reads a record.
#include "tests/support/catch.hpp"
#include "tests/tools/record_folder.hpp"

#include <string>
#include <vector>

using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using tactus::test::RecordFolder;
using tactus::test::RecordOutcome;
using tactus::test::tones;

namespace {

/// 2 s of 100 Hz, 2 s of 150 Hz, five times as strong, 2 s of 100 Hz.
std::vector<double> three_parts() {
    std::vector<double> x = tones({{100.0, 0.1}}, 2.0, 8000.0);
    const std::vector<double> strong = tones({{150.0, 0.5}}, 2.0, 8000.0), weak = x;
    x.insert(x.end(), strong.begin(), strong.end());
    x.insert(x.end(), weak.begin(), weak.end());
    return x;
}

constexpr double strong_rms = 0.5 / std::numbers::sqrt2, weak_rms = 0.1 / std::numbers::sqrt2;

}  // namespace

TEST_CASE("spectrum, orders and exposure analyse the stretch from --from to --to and say so") {
    const RecordFolder folder;
    folder.sound("parts.wav", three_parts(), 1, 8000);
    const json row = folder.tactus("spectrum --json --from '2 s' --to '4000 ms' parts.wav").only("rows");
    CHECK(row["duration_s"] == 2.0);
    CHECK(row["stretch"] == json{{"from_s", 2.0}, {"to_s", 4.0}, {"of_s", 6.0}});
    CHECK(row["channels"][0]["rms"].get<double>() == Approx(strong_rms).epsilon(1e-9));
    CHECK(row["channels"][0]["fundamental_hz"].get<double>() == Approx(150.0).margin(0.05));
    CHECK(folder.tactus("spectrum --json --to 2 parts.wav").only("rows")["channels"][0]["rms"].get<double>() ==
          Approx(weak_rms).epsilon(1e-9));
    CHECK_THAT(folder.tactus("spectrum --from 4.5 parts.wav").out,
               ContainsSubstring("of the record") && ContainsSubstring(" 4.5 s to 6 s of 6 s\n"));
    CHECK_FALSE(folder.tactus("spectrum parts.wav").out.find("of the record") != std::string::npos);

    const RecordOutcome orders = folder.tactus("orders --json --rate 150 --from 2 --to 4 parts.wav");
    CHECK(orders.answer()["channels"][0]["orders"][0]["rms"].get<double>() == Approx(strong_rms).epsilon(1e-3));
    CHECK(orders.answer()["stretch"]["to_s"] == 4.0);
    CHECK_THAT(folder.tactus("orders --rate 150 --from 2 --to 4 parts.wav").out,
               ContainsSubstring("2 s to 4 s of 6 s"));

    // ISO 5349-1 at 100 and 150 Hz, from the formula of the weighting; the ends of 2 s are weighted, too.
    const auto weighted = [&](const char* stretch) {
        return folder.tactus(std::string("exposure --json --uncalibrated ") + stretch + " parts.wav")
            .only("operations")["a_hw"][0]
            .get<double>();
    };
    CHECK(weighted("--to 2") == Approx(weak_rms * 0.16021).epsilon(0.01));
    CHECK(weighted("--from 2 --to 4") == Approx(strong_rms * 0.10642).epsilon(0.01));
    CHECK_THAT(folder.tactus("exposure --uncalibrated --from 2 --to 4 parts.wav").out,
               ContainsSubstring("2 s to 4 s of 6 s"));
}

TEST_CASE("a stretch of a log counts from its first row, whatever its clock says") {
    const RecordFolder folder;
    const std::vector<double> x = three_parts();
    std::string text = "time_ms,a\n";
    for (std::size_t i = 0; i < x.size(); i += 8)
        text += fmt::format("{},{:.9f}\n", 1234567.0 + 0.125 * static_cast<double>(i), x[i]);
    folder.text("log.csv", text);
    const json row = folder.tactus("spectrum --json --from 2 --to 4 log.csv").only("rows");
    CHECK(row["channels"][0]["rms"].get<double>() == Approx(strong_rms).epsilon(1e-6));
    CHECK(row["log"]["rows"] == 2000);
    CHECK(row["stretch"]["of_s"].get<double>() == Approx(6.0).epsilon(1e-6));
    CHECK(folder.tactus("spectrum --to 6.1 log.csv").code == 2);
    CHECK(folder.tactus("spectrum --to 6 log.csv").code == 0);
}

TEST_CASE("compare takes one stretch of both records, or one of each from its own start") {
    const RecordFolder folder;
    folder.sound("parts.wav", three_parts(), 1, 8000);
    folder.sound("strong.wav", tones({{150.0, 0.5}}, 2.0, 8000.0), 1, 8000);
    const RecordOutcome same = folder.tactus("compare --json --from 2,0 --to 4,2 parts.wav strong.wav");
    CHECK(same.code == 0);
    const json pair = same.only("pairs");
    CHECK(pair["rms"]["reference"].get<double>() == Approx(strong_rms).epsilon(0.01));
    CHECK(pair["stretch"]["reference"] == json{{"from_s", 2.0}, {"to_s", 4.0}, {"of_s", 6.0}});
    CHECK(pair["stretch"]["output"] == json{{"from_s", 0.0}, {"to_s", 2.0}, {"of_s", 2.0}});
    CHECK(folder.tactus("compare --to 2 parts.wav strong.wav").code == 1);
    CHECK_THAT(folder.tactus("compare --from 2,0 --to 4,2 parts.wav strong.wav").out,
               ContainsSubstring("compared: 2 s to 4 s of 6 s of the reference, 0 s to 2 s of 2 s of the output"));
    const RecordOutcome outside = folder.tactus("compare --from 2 --to 4 parts.wav strong.wav");
    CHECK(outside.code == 2);
    CHECK_THAT(outside.err, ContainsSubstring("strong.wav: is 2 s long"));
}

TEST_CASE("a stretch outside of the record is refused with the length of the record") {
    const RecordFolder folder;
    folder.sound("parts.wav", three_parts(), 1, 8000);
    for (const char* verb : {"spectrum", "orders --rate 100", "exposure --uncalibrated"})
        for (const char* stretch : {"--from 6", "--from 7", "--to 6.1", "--from 3 --to 2", "--from 3 --to 3"}) {
            const RecordOutcome outcome = folder.tactus(fmt::format("{} {} parts.wav", verb, stretch));
            CAPTURE(verb, stretch, outcome.err);
            CHECK(outcome.code == 2);
            CHECK_THAT(outcome.err, ContainsSubstring("6 s long"));
        }
    for (const char* stretch : {"--from '3 kg'", "--from -1", "--to x", "--from 1,2"}) {
        CAPTURE(stretch);
        CHECK(folder.tactus(fmt::format("spectrum {} parts.wav", stretch)).code == 2);
    }
}
