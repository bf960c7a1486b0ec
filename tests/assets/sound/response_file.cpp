// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/response_file.hpp"

#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

sound::ResponseFile read_response(const TemporaryFolder& folder, const std::string& text) {
    const auto path = folder / "r.csv";
    std::ofstream(path, std::ios::binary) << text;
    return sound::load_response(path);
}

}  // namespace

TEST_CASE("a response comes back from its file") {
    const TemporaryFolder folder;
    sound::ResponseFile made;
    made.title = "saw: a.b to c.d";
    made.unit = "m/s^2 per V";
    vibration::FrequencyResponse& response = made.identified.response;
    response.latency = 0.0026667;
    made.identified.distortions = {{2, {}}, {3, {}}};
    for (int i = 0; i < 50; ++i) {
        response.hz.push_back(20.0 * std::exp2(i / 10.0));
        response.gain.push_back(std::polar(0.1 + i, -0.2 * i));
        response.coherence.push_back(1.0 - 0.01 * i);
        made.identified.distortions[0].ratio.push_back(0.001 * i);
        made.identified.distortions[1].ratio.push_back(i < 30 ? 0.01 : std::numeric_limits<double>::quiet_NaN());
    }
    sound::save_response(made, folder / "r.csv");
    const sound::ResponseFile back = sound::load_response(folder / "r.csv");
    CHECK(back.title == made.title);
    CHECK(back.unit == made.unit);
    CHECK(back.identified.response.latency == Approx(response.latency));
    REQUIRE(back.identified.response.hz.size() == 50);
    REQUIRE(back.identified.distortions.size() == 2);
    for (std::size_t i = 0; i < 50; ++i) {
        CHECK(back.identified.response.hz[i] == Approx(response.hz[i]).epsilon(1e-6));
        CHECK(std::abs(back.identified.response.gain[i] - response.gain[i]) < 1e-5 * std::abs(response.gain[i]));
        CHECK(back.identified.response.coherence[i] == Approx(response.coherence[i]).margin(1e-6));
        CHECK(back.identified.distortions[0].ratio[i] == Approx(0.001 * static_cast<double>(i)).margin(1e-9));
        CHECK(std::isnan(back.identified.distortions[1].ratio[i]) == (i >= 30));
    }
}

TEST_CASE("tables of other programs are read: blanks, remarks, no names, no phases") {
    const TemporaryFolder folder;
    const sound::ResponseFile table =
        read_response(folder, "* Freq(Hz) SPL(dB) Phase(degrees)\n0 -80 0\n10.0 6.0206 90\n20\t0 -90.0\n40 +3 0\n");
    REQUIRE(table.identified.response.hz.size() == 3);
    CHECK(std::abs(table.identified.response.gain[0] - std::complex<double>(0.0, 2.0)) < 1e-4);
    CHECK(std::abs(table.identified.response.gain[1] - std::complex<double>(0.0, -1.0)) < 1e-4);

    // Names are separated otherwise than numbers; a coherence; commas and tabs.
    const auto& right = table.identified.response;
    for (const char* const text : {"Freq(Hz), SPL(dB), Phase(degrees)\n10.0 6.0206 90\n20 0 -90.0\n40 +3 0\n",
                                   "10.0 6.0206 90 0.99\n20 0 -90.0 0.98\n40 +3 0 0.97\n",
                                   "10.0,\t6.0206,\t90\n20,\t0,\t-90.0\n40,\t+3,\t0\n"}) {
        INFO(text);
        const auto read = read_response(folder, text).identified.response;
        CHECK(read.hz == right.hz);
        CHECK(read.gain == right.gain);
    }

    // A level that rises 6 dB per octave has a phase of 90°.
    std::string rising = "dB;Hz\r\n";
    for (int i = 0; i < 20; ++i) rising += std::to_string(6.0206 * i) + ";" + std::to_string(std::exp2(i)) + "\r\n";
    const sound::ResponseFile guessed = read_response(folder, rising);
    for (const auto& gain : guessed.identified.response.gain) CHECK(std::arg(gain) == Approx(M_PI / 2.0).margin(1e-3));
}

TEST_CASE(
    "numbers with decimal commas are read between semicolons or tabs, and rows with more cells than names refused") {
    const TemporaryFolder folder;
    const char* const with_points = "Freq(Hz);SPL(dB);Phase(degrees)\n20.5;-3.1;10.0\n40.5;-2.2;20.0\n80.5;-1.4;30.0\n";
    const auto right = read_response(folder, with_points).identified.response;
    std::string commas = with_points, tabs;
    std::ranges::replace(commas, '.', ',');
    tabs = commas;
    std::ranges::replace(tabs, ';', '\t');
    for (const std::string& text : {commas, tabs}) {
        INFO(text);
        const auto read = read_response(folder, text).identified.response;
        CHECK(read.hz == right.hz);
        CHECK(read.gain == right.gain);
    }
    std::string doubtful = "hz;db;deg\n";
    for (const char* const row : {"1,250;-3;10\n", "2,500;-2;20\n", "5,125;-1;30\n"}) doubtful += row;
    CHECK_THROWS_WITH(read_response(folder, doubtful), ContainsSubstring("r.csv:2") && ContainsSubstring("1,250"));
    CHECK_THROWS_WITH(read_response(folder, "hz,db,deg\n20,5,-3,1,10,0\n40,5,-2,2,20,0\n"),
                      ContainsSubstring("r.csv:2") && ContainsSubstring("6 cells") && ContainsSubstring("decimal"));
    CHECK_THROWS_WITH(read_response(folder, "20,5,-3,1,10,0\n40,5,-2,2,20,0\n"), ContainsSubstring("6 cells"));
}

TEST_CASE("a table that is no response is refused with its line") {
    const TemporaryFolder folder;
    const std::pair<const char*, const char*> slips[] = {
        {"", "3 frequencies"},
        {"10 0\n20 0\n", "3 frequencies"},
        {"10 0\n20 x\n30 0\n", ":2:"},
        {"10 0\n10 0\n30 0\n", "increase"},
        {"10 0\n5 0\n30 0\n", "increase"},
        {"-10 0\n5 0\n30 0\n", "negative"},
        {"10 nan\n20 0\n30 0\n", ":1:"},
        {"10 1e9\n20 0\n30 0\n", "-400 and 400"},
        {"apples,pears\n1,2\n2,3\n3,4\n", "no columns"},
        {"frequency_hz,level_db,order_x\n", "is not an order"},
        {"hz,db\n1,2\nhz,db\n", ":3:"},
        {"# latency_s = soon\n", "seconds"},
    };
    for (const auto& [text, message] : slips) {
        INFO(text);
        CHECK_THROWS_WITH(read_response(folder, text), ContainsSubstring(message) && ContainsSubstring("r.csv"));
    }
}
