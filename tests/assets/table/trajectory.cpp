// SPDX-License-Identifier: Apache-2.0
#include "assets/table/trajectory.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <unistd.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

/// A file that lives as long as the test.
struct Csv {
    std::filesystem::path path;

    explicit Csv(const std::string& text) {
        static int count = 0;
        path = std::filesystem::temp_directory_path() /
               ("tactus_trajectory_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ".csv");
        std::ofstream(path) << text;
    }
    ~Csv() { std::filesystem::remove(path); }
    Csv(const Csv&) = delete;
    Csv& operator=(const Csv&) = delete;

    std::string error(const table::TrajectorySelection& selection = {}) const {
        try {
            table::read_trajectory(path, selection);
        } catch (const Error& caught) {
            return caught.what();
        }
        return {};
    }
};

const std::string header = "t_s,trial,px_mm,py_mm,pz_mm,qx,qy,qz,qw,fx_N,fy_N,fz_N\n";
const std::string first = "1.00,1,10,20,30,0,0,0,1,0.1,0.2,0.3\n";

}  // namespace

TEST_CASE("a trajectory is read in SI with its forces, whatever line ends it has") {
    const Csv csv(
        "\xef\xbb\xbft_ms,px_cm,py_cm,pz_cm,qx,qy,qz,qw,fx_N,fy_N,fz_N,note\r\n"
        "0, 1, 2,3,0,0,0,1,0.1,0.2,0.3,a\r\n"
        "16,1,2,4,0,0,1,0,0,0,0,b\r\n");
    const table::Trajectory t = table::read_trajectory(csv.path);
    REQUIRE(t.samples.size() == 2);
    CHECK(t.samples[1].time == Approx(0.016));
    CHECK(t.samples[1].pose.position.z == Approx(0.04));
    CHECK(t.samples[1].pose.orientation.z == Approx(1.0));
    REQUIRE(t.forces.size() == 2);
    CHECK(t.forces[0].y == Approx(0.2));
    CHECK(t.median_step_s == Approx(0.016));
}

TEST_CASE("a new trial begins a segment, and one trial can be chosen") {
    const Csv csv(header + first + "1.02,1,11,20,30,0,0,0,1,0,0,0\n" + "1.04,2,80,20,30,0,0,0,1,0,0,0\n");
    const table::Trajectory all = table::read_trajectory(csv.path);
    CHECK(all.breaks == std::vector<std::size_t>{2});
    const table::Trajectory second = table::read_trajectory(csv.path, {"", 2});
    REQUIRE(second.samples.size() == 1);
    CHECK(second.samples[0].pose.position.x == Approx(0.08));
    CHECK_THAT(csv.error({"", 9}), ContainsSubstring("no trial 9") && ContainsSubstring("1, 2"));
}

TEST_CASE("a tool is chosen by the prefix of its columns, and lost samples are left out") {
    const Csv csv(
        "t_s,A_status,A_px_mm,A_py_mm,A_pz_mm,A_qx,A_qy,A_qz,A_qw\n"
        "0.00,OK,1,2,3,0,0,0,1\n"
        "0.06,OUT_OF_VIEW,0,0,0,0,0,0,0\n"
        "0.12,OK,1,2,4,0,0,0,1\n");
    const table::Trajectory t = table::read_trajectory(csv.path, {"A", 0});
    CHECK(t.samples.size() == 2);
    CHECK(t.lost == 1);
    CHECK_THAT(csv.error(), ContainsSubstring("px_mm") && ContainsSubstring("the file has the tools A"));
}

TEST_CASE("a trial whose first samples are lost begins a segment at its first sample") {
    std::string text = "t_s,px_mm,py_mm,pz_mm,qw,qx,qy,qz,trial,status\n";
    for (int i = 0; i <= 200; ++i)
        text += fmt::format("{:.3f},{},0,20,1,0,0,0,{},{}\n", 0.01 * i, i <= 100 ? 0 : 60, i <= 100 ? 1 : 2,
                            i == 101 || i == 102 ? "LOST" : "OK");
    const Csv csv(text);
    const table::Trajectory t = table::read_trajectory(csv.path);
    CHECK(t.lost == 2);
    CHECK(t.breaks == std::vector<std::size_t>{101});
    const simulate::TrajectoryPlayer player(t.samples, t.breaks, t.rules());
    std::size_t hint = 0;
    double peak = 0.0;
    for (double time = 0.0; time < player.duration(); time += 0.001)
        peak = std::max(peak, glm::length(player.at(time, hint).intention.twist.linear));
    CHECK(peak < 0.1);
}

TEST_CASE("a bad file is refused in one line that says where") {
    const auto said = [](const std::string& text) { return Csv(text).error(); };
    CHECK_THAT(said(""), ContainsSubstring("empty"));
    CHECK_THAT(said(header), ContainsSubstring("no sample"));
    CHECK_THAT(said("t_s,px_mm\n0,1\n"), ContainsSubstring(":1:1: there is no column py_mm or py_cm or py_m"));
    CHECK_THAT(said(header + first + "1.02,1,nan,20,30,0,0,0,1,0,0,0\n"),
               ContainsSubstring(":3:8: 'nan' in column px_mm"));
    CHECK_THAT(said(header + first + "1.02,1,x,20,30,0,0,0,1,0,0,0\n"), ContainsSubstring(":3:8: 'x'"));
    CHECK_THAT(said(header + first + "1.02,1,1e999,20,30,0,0,0,1,0,0,0\n"), ContainsSubstring(":3:8:"));
    CHECK_THAT(said(header + first + "1.02,1,11,20,30,0,0,0,0,0,0,0\n"),
               ContainsSubstring(":3:") && ContainsSubstring("length 0"));
    CHECK_THAT(said(header + first + first), ContainsSubstring(":3:1:") && ContainsSubstring("times must increase"));
    CHECK_THAT(said(header + first + "0.9,1,11,20,30,0,0,0,1,0,0,0\n"), ContainsSubstring(":3:1:"));
    CHECK_THAT(said(header + first + "1.02,1,11\n"), ContainsSubstring(":3:1: the line has 3 fields"));
    CHECK_THROWS_WITH(table::read_trajectory("/nowhere/at_all.csv"), ContainsSubstring("cannot be read"));
}

TEST_CASE("a slow recording is not all gaps, a fast one keeps the 50 ms") {
    table::Trajectory slow, fast;
    slow.median_step_s = 1.0 / 15.0;
    fast.median_step_s = 0.016;
    CHECK(slow.rules().max_gap_s == Approx(0.1));
    CHECK(fast.rules().max_gap_s == Approx(0.05));
}

TEST_CASE("a recording of a haptic device plays at 1 kHz near its own speed") {
    const char* const data = std::getenv("TACTUS_SHARED_DATA");
    if (data == nullptr) {
        tactus::test::skip("TACTUS_SHARED_DATA does not name a folder with trajectories/omni_scalpel_trials_a.csv");
        return;
    }
    const table::Trajectory t =
        table::read_trajectory(std::filesystem::path(data) / "trajectories/omni_scalpel_trials_a.csv");
    CHECK(t.samples.size() == 2207);
    const simulate::TrajectoryPlayer player(t.samples, t.breaks, t.rules());
    CHECK(player.gaps() == 5);
    std::size_t hint = 0;
    double peak = 0.0;
    for (double time = 0.0; time < player.duration(); time += 0.001) {
        const simulate::TrajectoryState state = player.at(time, hint);
        REQUIRE(is_valid(state.intention.pose));
        peak = std::max(peak, glm::length(state.intention.twist.linear));
    }
    CHECK(peak > 0.14);
    CHECK(peak < 0.21);
}
