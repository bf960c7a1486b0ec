// SPDX-License-Identifier: Apache-2.0
// Studies as another program calls them: settings in, results out.
#include "tools/analysis/vibration/spectrum_analysis.hpp"

#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/analysis/vibration/exposure.hpp"
#include "tools/analysis/vibration/orders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace tactus;
using tactus::test::Folder;

namespace {

/// Two seconds of a sine of 80 Hz, amplitude 5, every 0.5 ms.
std::filesystem::path sine_log(const Folder& folder) {
    std::string text = "time_s,x\n";
    for (int n = 0; n < 4000; ++n) {
        const double t = n * 0.5e-3;
        text += fmt::format("{},{}\n", t, 5.0 * std::sin(2.0 * std::numbers::pi * 80.0 * t));
    }
    return folder.write("sine.csv", text);
}

}  // namespace

TEST_CASE("a program finds the fundamental of a record without the command") {
    const Folder folder;
    analysis::SpectrumSettings settings;
    double told = 0.0;
    const analysis::AnalysedFile found =
        analysis::analyse_file(sine_log(folder), settings, [&told](double share) { told = share; });
    REQUIRE(found.channels.size() == 1);
    CHECK(found.channels[0].name == "x");
    CHECK(found.channels[0].report.fundamental.frequency == Approx(80.0).margin(0.1));
    CHECK(found.channels[0].report.level.rms() == Approx(5.0 / std::sqrt(2.0)).epsilon(1e-3));
    CHECK_FALSE(found.channels[0].report.spectrogram.has_value());
    CHECK(told == 1.0);
}

TEST_CASE("a program finds the orders of a machine of known rate without the command") {
    const Folder folder;
    analysis::OrdersSettings settings;
    settings.fixed = 40.0;
    settings.highest = 3;
    const analysis::Orders found = analysis::analyse_orders(sine_log(folder), settings);
    CHECK(found.source == "fixed");
    CHECK(found.rate.mean == Approx(40.0));
    REQUIRE(found.channels.size() == 1);
    const auto& orders = found.channels[0].spectrum.orders;
    const auto second = std::ranges::find(orders, 2.0, &signal::OrderLevel::order);
    REQUIRE(second != orders.end());
    CHECK(second->amplitude == Approx(5.0).epsilon(0.01));
}

TEST_CASE("a program adds up the exposure of a day without the command") {
    const Folder folder;
    analysis::ExposureSettings settings;
    settings.uncalibrated = true;
    const analysis::ExposureOperation hour =
        analysis::analyse_exposure(sine_log(folder), settings, 3600.0, [](double) {});
    CHECK(hour.is_lower_bound());
    const std::vector<analysis::ExposureOperation> twice{hour, hour};
    const auto day = analysis::exposure_of_day(twice);
    REQUIRE(day);
    CHECK(*day == Approx(hour.total() * std::sqrt(2.0 / 8.0)));
    const std::vector<analysis::ExposureOperation> too_long(25, hour);
    CHECK_FALSE(analysis::exposure_of_day(too_long));
}
