// SPDX-License-Identifier: Apache-2.0
// The library's saw on the library's jaw, as a hand feels it.
#include "assets/table/number_table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/line_amplitude.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <string>
#include <vector>

using namespace tactus;

namespace {

/// No windows of 2 s of a run have a line at the rate of carving in the force.
void check_no_line(const std::string& thrust, int seconds) {
    const test::Folder folder;
    const test::Outcome outcome =
        folder.tactus("render saw-training --seconds " + std::to_string(seconds) + " --set simulated.thrust='" +
                      thrust + "' -o " + (folder.path / "out").string());
    REQUIRE(outcome.code == 0);
    const std::vector<double> all = table::load_number_table(folder.path / "out" / "force.csv").numbers("fz_N");
    REQUIRE(all.size() >= 1000 * static_cast<std::size_t>(seconds));
    for (std::size_t begin = 1500; begin + 2000 <= all.size(); begin += 1000) {
        const std::span<const double> part = std::span(all).subspan(begin, 2000);
        double floor = 0.0;
        for (const double hz : {50.0, 52.0, 54.0, 56.0, 64.0, 66.0, 68.0, 70.0})
            floor += test::line_amplitude(part, hz) / 8.0;
        CAPTURE(thrust, begin, floor, test::line_amplitude(part, 60.0));
        CHECK(test::line_amplitude(part, 60.0) < floor + 0.01);
    }
}

}  // namespace

TEST_CASE("carving at 60 Hz is no line in the force of a saw that is pushed hard on the jaw", "[slow]") {
    check_no_line("20 N", 4);
}

TEST_CASE("carving at 60 Hz is no line in the force of a saw on the jaw, pushed gently or hard", "[long]") {
    for (const char* thrust : {"7.5 N", "20 N"}) check_no_line(thrust, 10);
}

TEST_CASE("a hand that rocks the saw with 20 N cuts through the jaw and is not caught in its own cut", "[long]") {
    const test::Folder folder;
    const test::Outcome outcome = folder.tactus(
        "render saw-training --seconds 22 --set simulated.thrust='20 N' --set "
        "simulated.stroke_amplitude='6 mm' -o " +
        (folder.path / "out").string());
    REQUIRE(outcome.code == 0);
    const auto summary = nlohmann::json::parse(test::slurp(folder.path / "out" / "summary.json"));
    CHECK(summary["carve"]["severed"].get<double>() == 1.0);
    // 1.3 mm while it cuts. At break-through the hand plunges towards 20 N / (2 N/mm) = 10 mm, and the body of the blade meets
    // bone that carve, two ticks behind, has not removed yet.
    CHECK(summary["contact"]["max_penetration_mm"].get<double>() < 4.0);
}
