// SPDX-License-Identifier: Apache-2.0
// The scripted case: a mandible in twelve pieces is put together by a hand that stops 5 mm and 10 degrees beside each
// place.
#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/jaw_case.hpp"
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
#include <sstream>
#include <string>
#include <vector>

using namespace tactus;
using nlohmann::json;
using tactus::test::case_folder;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::pose_in;
using tactus::test::slurp;
using tactus::test::truth;

namespace {

namespace fs = std::filesystem;

/// What the hand does and when: 'TIME s: place | buttons', one line each.
struct HandLine {
    double time;
    std::string place, buttons;
    bool has(const char* button) const { return buttons.find(button) != std::string::npos; }
};

std::vector<HandLine> hand_lines() {
    std::vector<HandLine> lines;
    std::ifstream file(case_folder() / "hand.txt");
    for (std::string line; std::getline(file, line);) {
        const auto colon = line.find(':'), bar = line.find('|');
        if (colon == std::string::npos || bar == std::string::npos || line.starts_with('#')) continue;
        lines.push_back({std::stod(line), line.substr(colon, bar - colon), line.substr(bar)});
    }
    return lines;
}

/// The force before the limiter, one per millisecond.
std::vector<Vec3> forces(const fs::path& path) {
    std::vector<Vec3> all;
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        Vec3 f;
        double t = 0.0;
        REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &t, &f.x, &f.y, &f.z) == 4);
        all.push_back(f);
    }
    return all;
}

/// From one millisecond to the next, the most within so many after `time`.
double step_after(const std::vector<Vec3>& force, double time, double milliseconds) {
    double most = 0.0;
    for (auto k = static_cast<std::size_t>(time * 1e3);
         k < force.size() && static_cast<double>(k) < time * 1e3 + milliseconds; ++k)
        if (k > 0) most = std::max(most, glm::length(force[k] - force[k - 1]));
    return most;
}

/// Renders the scripted case for so many seconds, in which the hand settles so many pieces and rests at least so often.
void put_together(int seconds, std::size_t pieces, int rests) {
    const Folder folder;
    const fs::path out = folder.path / "out", take = folder.path / "take";
    const Outcome run = folder.tactus("render planning-trauma --seconds " + std::to_string(seconds) + " --out " +
                                      out.string() + " --record " + take.string());
    INFO(run.err);
    REQUIRE(run.code == 0);
    const json summary = json::parse(slurp(out / "summary.json"));
    CHECK(summary["faults"].empty());
    const json plan = json::parse(slurp(out / "case.plan.json"));
    // The last place of each fragment along the steps.
    std::map<std::string, Pose> placed;
    std::map<std::string, int> settled;
    for (const json& step : plan["steps"]) {
        if (step["kind"] != "place") continue;
        CHECK(step["by"] == "settle");
        CHECK(step["fit"]["verdict"] == "fit");
        for (std::size_t n = 0; n < step["fragments"].size(); ++n)
            placed[step["fragments"][n].get<std::string>()] = pose_in(step["poses"][n]);
        ++settled[step["fragments"][0].get<std::string>()];
    }
    CHECK(placed.size() == pieces);
    double worst = 0.0, worst_turn = 0.0, chain = 0.0;
    for (const auto& [name, belongs] : truth()) {
        if (!placed.contains(name)) continue;
        const Pose& wanted = belongs.pose;
        CAPTURE(name, settled[name]);
        const Pose off = placed[name] * wanted.inverse();
        const double turn =
            glm::length(rotation_between({1.0, 0.0, 0.0, 0.0}, off.orientation)) * 180.0 / std::numbers::pi;
        const double away = glm::length(placed[name].apply(belongs.middle) - wanted.apply(belongs.middle));
        CHECK(away < 0.3e-3);
        CHECK(turn < 0.5);
        worst = std::max(worst, away);
        worst_turn = std::max(worst_turn, turn);
        chain = std::max(chain, away);
    }
    CAPTURE(worst * 1e3, worst_turn);
    CHECK(chain < 0.5e-3);
    // What the hand feels: hardly ever limited, still when the hand is, no step when it takes or lets go, and none from
    // when it asks until the settled piece is let go, over whatever teeth the piece slips meanwhile.
    CHECK(summary["contact"]["limited_ticks"].get<double>() < 1e-3 * summary["force"]["ticks"].get<double>());
    const std::vector<Vec3> force = forces(out / "force.csv");
    const std::vector<HandLine> hand = hand_lines();
    REQUIRE(force.size() == static_cast<std::size_t>(seconds) * 1000);
    double ripple = 0.0, taken = 0.0, led = 0.0;
    int stills = 0;
    for (std::size_t n = 1; n < hand.size() && hand[n].time < seconds - 1.0; ++n) {
        const HandLine &last = hand[n - 1], &now = hand[n];
        if (last.has("trigger") != now.has("trigger")) taken = std::max(taken, step_after(force, now.time, 100.0));
        if (last.has("second")) led = std::max(led, step_after(force, last.time, (now.time - last.time) * 1e3));
        if (last.place != now.place || now.time - last.time < 0.15 || !last.has("trigger")) continue;
        ++stills;
        const auto end = static_cast<std::size_t>(now.time * 1e3);
        for (std::size_t k = end - 100; k < end; ++k) ripple = std::max(ripple, glm::length(force[k] - force[end - 1]));
    }
    CAPTURE(ripple, taken, led, stills);
    CHECK(stills >= rests);
    CHECK(ripple < 5e-3);
    CHECK(taken < 0.02);
    CHECK(led < 0.15);
    // A process of its own opens the plan and has the same poses; so has the take that is replayed.
    const json shown = json::parse(folder.tactus("plan show " + (out / "case.plan.json").string() + " --json").out);
    CHECK(shown["problems"].empty());
    CHECK(shown["steps_done"] == plan["steps"].size());
    for (const json& fragment : shown["fragments"])
        if (const std::string name = fragment["name"]; placed.contains(name))
            for (std::size_t axis = 0; axis < 3; ++axis)
                CHECK(fragment["pose"]["position_mm"][axis].get<double>() ==
                      placed[name].position[static_cast<int>(axis)] * 1e3);
    const Outcome again = folder.tactus("replay " + take.string());
    INFO(again.out << again.err);
    CHECK(again.code == 0);
}

}  // namespace

// Costly: 9 s of the patch, and its replay.
TEST_CASE("render planning-trauma: the first pieces within 0.3 mm and 0.5 degrees, the chain within 0.5 mm", "[slow]") {
    put_together(9, 2, 5);
}

TEST_CASE("render planning-trauma: every piece within 0.3 mm and 0.5 degrees, the chain within 0.5 mm", "[.][long]") {
    put_together(90, 11, 51);
}
