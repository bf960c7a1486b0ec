// SPDX-License-Identifier: Apache-2.0
// The scripted reconstruction: a hand lifts out the resected piece, folds three segments, brings them into the gap, sews
// the vessels and feels them pull.
#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/plan_pose.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

using namespace tactus;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::pose_in;
using tactus::test::slurp;

namespace {

namespace fs = std::filesystem;

/// The last place of each piece on the way to step `head`.
std::map<std::string, Pose> places(const json& plan, int head) {
    std::vector<int> way;
    for (int n = head; n >= 0; n = plan["steps"][static_cast<std::size_t>(n)]["after"].get<int>()) way.push_back(n);
    std::map<std::string, Pose> all;
    for (auto n = way.rbegin(); n != way.rend(); ++n) {
        const json& step = plan["steps"][static_cast<std::size_t>(*n)];
        if (step["kind"] != "place") continue;
        for (std::size_t k = 0; k < step["fragments"].size(); ++k)
            all[step["fragments"][k].get<std::string>()] = pose_in(step["poses"][k]);
    }
    return all;
}

/// Columns after the time.
std::vector<std::vector<double>> rows_of(const fs::path& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(file, line)) {
        std::vector<double> row;
        for (std::size_t at = line.find(','); at != std::string::npos; at = line.find(',', at + 1))
            row.push_back(std::stod(line.substr(at + 1)));
        rows.push_back(row);
    }
    return rows;
}

}  // namespace

// Costly: the only run of a whole reconstruction.
TEST_CASE("render planning-reconstruction: every segment at its planned place, in few steps, and the vessel reached",
          "[slow]") {
    const Folder folder;
    const fs::path out = folder.path / "out", take = folder.path / "take";
    const Outcome run = folder.tactus("render planning-reconstruction --seconds 25 --out " + out.string() +
                                      " --record " + take.string());
    INFO(run.err);
    REQUIRE(run.code == 0);
    const json summary = json::parse(slurp(out / "summary.json"));
    CHECK(summary["faults"].empty());
    const json before = json::parse(slurp(tactus::test::library_folder() / "cases/fibula-flap/case.plan.json"));
    const json plan = json::parse(slurp(out / "case.plan.json"));
    const std::string script = slurp(tactus::test::library_folder() / "cases/fibula-flap/hand.txt");
    CHECK(std::ranges::count(script, '\n') <= 60);
    CHECK(plan["steps"].size() > before["steps"].size() + 5);
    CHECK(plan["steps"].size() <= before["steps"].size() + 60);

    // Where the first alternative of the plan ends.
    const auto planned = places(before, before["alternatives"][0]["tip"].get<int>());
    const auto reached = places(plan, static_cast<int>(plan["steps"].size()) - 1);
    for (const char* name : {"segment-1", "segment-2", "segment-3"}) {
        const Pose off = reached.at(name) * planned.at(name).inverse();
        // Of a point of the jaw near it.
        const double away = glm::length(off.apply(Vec3(0.02, -0.035, -0.007)) - Vec3(0.02, -0.035, -0.007));
        const double turn = glm::length(rotation_between({1.0, 0.0, 0.0, 0.0}, off.orientation));
        CAPTURE(name, away * 1e3, turn * 180.0 / std::numbers::pi);
        CHECK(away < 0.1e-3);
        CHECK(turn * 180.0 / std::numbers::pi < 0.1);
    }
    int settled = 0, joined = 0;
    for (std::size_t n = before["steps"].size(); n < plan["steps"].size(); ++n) {
        settled += plan["steps"][n]["by"] == "settle";
        joined += plan["steps"][n]["kind"] == "group";
    }
    CHECK(settled == 4);
    CHECK(joined == 2);

    // Coming from the stump the hand is stopped where the plan's margin to the tumour ends, and nowhere else.
    const auto stopped = rows_of(out / "margin.csv");
    double pushed = 0.0, later = 0.0;
    for (std::size_t n = 0; n < stopped.size(); ++n) {
        double& most = n < 1700 ? pushed : later;
        most = std::max(most, glm::length(Vec3(stopped[n][0], stopped[n][1], stopped[n][2])));
    }
    CHECK(pushed > 2.0);
    CHECK(pushed <= 8.0);
    CHECK(later == 0.0);

    // The artery reaches; while the hand pulls the jaw forward it is felt three times as strong as it is.
    CHECK(summary["artery"]["verdict"].get<double>() <= 1.0);
    CHECK(summary["vein"]["verdict"].get<double>() <= 1.0);
    CHECK(summary["artery"]["tension_max_N"].get<double>() > 0.1);
    CHECK(summary["artery"]["gain"] == 3.0);
    const auto felt = rows_of(out / "artery-felt.csv"), tension = rows_of(out / "artery-tension.csv");
    REQUIRE(felt.size() == tension.size());
    double worst = 0.0, greatest = 0.0;
    for (std::size_t n = 0; n < felt.size(); ++n) {
        const double force = glm::length(Vec3(felt[n][0], felt[n][1], felt[n][2]));
        greatest = std::max(greatest, force);
        if (tension[n][0] > 0.1 && force > 0.3) worst = std::max(worst, std::abs(force / 3.0 / tension[n][0] - 1.0));
    }
    CAPTURE(worst, greatest);
    CHECK(greatest > 0.3);
    CHECK(greatest <= 4.0 + 1e-9);
    const Outcome again = folder.tactus("replay " + take.string());
    INFO(again.out << again.err);
    CHECK(again.code == 0);
}
