// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/exposure.hpp"

#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/analysis/vibration/body_exposure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using analysis::ExposureVerdict;

TEST_CASE("a lower bound of an exposure never gives a verdict that it is low enough") {
    for (double a8 = 0.0; a8 < 8.0; a8 += 0.1) {
        CAPTURE(a8);
        const ExposureVerdict whole = analysis::judge_exposure(a8, signal::hand_arm_limits, false),
                              bound = analysis::judge_exposure(a8, signal::hand_arm_limits, true);
        CHECK(whole == (a8 > 5.0   ? ExposureVerdict::above_limit
                        : a8 > 2.5 ? ExposureVerdict::above_action
                                   : ExposureVerdict::below_action));
        CHECK(bound == (a8 > 5.0   ? ExposureVerdict::above_limit
                        : a8 > 2.5 ? ExposureVerdict::at_least_above_action
                                   : ExposureVerdict::cannot_be_judged));
    }
}

TEST_CASE("a record of which more than a hundredth is lost never proves that an exposure is low enough") {
    const test::Folder folder;
    const auto log_of = [&](int lost_rows, bool has_rows) {
        std::string text = "t (s),ax (m/s^2),ay (m/s^2),az (m/s^2)\n";
        for (int i = 0; i < 10000; ++i) {
            const bool is_lost = i >= 3000 && i < 3000 + lost_rows;
            const double x = 0.01 * std::sin(0.1 * i);
            if (!is_lost) text += fmt::format("{:.4f},{:.5f},{:.5f},{:.5f}\n", 2e-4 * i, x, x, x);
            else if (has_rows) text += fmt::format("{:.4f},nan,nan,nan\n", 2e-4 * i);
        }
        return folder.write(fmt::format("{}_{}.csv", lost_rows, has_rows), text);
    };
    const auto quiet = [](double) {};
    for (const bool has_rows : {true, false}) {
        CAPTURE(has_rows);
        for (const auto& [lost, is_bound] : {std::pair{0, false}, {50, false}, {200, true}, {4600, true}}) {
            CAPTURE(lost);
            const std::filesystem::path file = log_of(lost, has_rows);
            const analysis::ExposureOperation hand = analysis::analyse_exposure(file, {}, 3600.0, quiet);
            CHECK(hand.is_lower_bound() == is_bound);
            const analysis::BodyOperation body =
                analysis::analyse_body_exposure(file, {}, signal::BodyJudgement::health, 3600.0, quiet);
            CHECK(body.is_lower_bound() == is_bound);
            const auto day = analysis::body_day(std::array{body});
            REQUIRE(day);
            CHECK(day->verdict() == (is_bound ? ExposureVerdict::cannot_be_judged : ExposureVerdict::below_action));
            for (const std::vector<std::string>& notes : {hand.notes, body.notes})
                CHECK(std::ranges::any_of(notes, [](const std::string& note) {
                          return note.find("% of the record is missing") != std::string::npos;
                      }) == is_bound);
        }
    }
}

TEST_CASE("one axis of three, a band that ends at 100 Hz and a clipped record make a lower bound") {
    analysis::ExposureOperation one;
    one.three_axes = true;
    CHECK_FALSE(one.is_lower_bound());
    analysis::ExposureOperation axis = one, band = one, clipped = one;
    axis.three_axes = false;
    band.band_high = 100.0;
    clipped.clipped = 1;
    CHECK(axis.is_lower_bound());
    CHECK(band.is_lower_bound());
    CHECK(clipped.is_lower_bound());
}
