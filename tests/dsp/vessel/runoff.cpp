// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/runoff.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <set>

using namespace tactus;
using vessel::LegArtery;

namespace {

// A right leg: z falls from 400 mm at the knee to 0; the fibula lies right (x < 0) of the tibia and a little behind (y > 0).
vessel::LegGeometry right_leg() {
    return {true, Vec3(0.0, 0.0, 0.4), Vec3(0.0, 0.0, 0.0), Vec3(-0.035, 0.015, 0.38), Vec3(-0.035, 0.015, -0.01)};
}
vessel::LegGeometry left_leg() {
    vessel::LegGeometry leg = right_leg();
    leg.is_right = false;
    for (Vec3* p : {&leg.tibia_top, &leg.tibia_bottom, &leg.fibula_top, &leg.fibula_bottom}) p->x = -p->x;
    return leg;
}

vessel::Branch line(double x, double y, double from, double to) {
    vessel::Branch branch;
    for (double level = from; level <= to; level += 0.005) {
        vessel::Node node;
        node.position = Vec3(x, y, 0.4 * (1.0 - level));
        node.along = 0.4 * (level - from);
        branch.nodes.push_back(node);
    }
    return branch;
}

// Anterior tibial in front of both bones, posterior tibial behind the tibia, peroneal behind, near the fibula.
vessel::Track arteries(std::set<LegArtery> seen, double side, double down_to = 0.95) {
    vessel::Track track;
    track.branches.push_back(line(side * 0.01, 0.02, 0.1, 0.33));
    if (seen.contains(LegArtery::anterior_tibial)) track.branches.push_back(line(side * 0.02, -0.012, 0.3, down_to));
    if (seen.contains(LegArtery::posterior_tibial)) track.branches.push_back(line(side * 0.002, 0.025, 0.3, down_to));
    if (seen.contains(LegArtery::peroneal)) track.branches.push_back(line(side * 0.028, 0.03, 0.3, 0.85));
    return track;
}

bool warns(const vessel::RunOff& found, std::string_view of) {
    for (const std::string& warning : found.warnings)
        if (warning.find(of) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("the three arteries of either leg are told apart by their place beside the bones") {
    for (const bool is_right : {true, false}) {
        CAPTURE(is_right);
        const auto found = vessel::run_off(
            arteries({LegArtery::anterior_tibial, LegArtery::posterior_tibial, LegArtery::peroneal}, is_right ? -1 : 1),
            is_right ? right_leg() : left_leg());
        CHECK(found.is_judged);
        CHECK(found.warnings.empty());
        for (const vessel::SeenArtery& artery : found.arteries) CHECK((artery.is_seen && artery.reaches_foot));
        for (const LegArtery alone : {LegArtery::anterior_tibial, LegArtery::posterior_tibial, LegArtery::peroneal}) {
            const auto one = vessel::run_off(arteries({alone}, is_right ? -1 : 1), is_right ? right_leg() : left_leg());
            for (std::size_t n = 0; n < 3; ++n) CHECK(one.arteries[n].is_seen == (static_cast<LegArtery>(n) == alone));
        }
    }
}

TEST_CASE("whoever plans is warned when the peroneal artery may be the only one, or was not found") {
    const auto leg = right_leg();
    CHECK(warns(vessel::run_off(arteries({LegArtery::peroneal}, -1), leg), "the only one"));
    CHECK(warns(vessel::run_off(arteries({LegArtery::anterior_tibial, LegArtery::posterior_tibial}, -1), leg),
                "peroneal artery was not found"));
    CHECK(warns(vessel::run_off(arteries({LegArtery::peroneal, LegArtery::anterior_tibial}, -1), leg),
                "posterior tibial artery is not seen"));
    // Both tibial arteries end in the calf.
    CHECK(warns(
        vessel::run_off(
            arteries({LegArtery::anterior_tibial, LegArtery::posterior_tibial, LegArtery::peroneal}, -1, 0.72), leg),
        "the only one"));
    vessel::Track lost = arteries({LegArtery::anterior_tibial, LegArtery::posterior_tibial, LegArtery::peroneal}, -1);
    for (std::size_t n = 20; n < 30; ++n) lost.branches[3].nodes[n].is_lost = true;
    CHECK(warns(vessel::run_off(lost, leg), "peroneal artery has a stretch"));
}

TEST_CASE("a track that does not cover the leg is not judged") {
    vessel::Track track;
    track.branches.push_back(line(-0.01, 0.02, 0.1, 0.5));
    const auto found = vessel::run_off(track, right_leg());
    CHECK_FALSE(found.is_judged);
    CHECK(warns(found, "unknown"));
    CHECK(warns(vessel::run_off({}, right_leg()), "unknown"));
}

TEST_CASE("bones of the other side, too short or upside down are refused") {
    vessel::LegGeometry leg = right_leg();
    leg.is_right = false;
    CHECK_THROWS_AS(vessel::run_off({}, leg), Error);
    leg = right_leg();
    leg.tibia_bottom = Vec3(0.0, 0.0, 0.35);
    CHECK_THROWS_AS(vessel::run_off({}, leg), Error);
    leg = right_leg();
    std::swap(leg.fibula_top, leg.fibula_bottom);
    CHECK_THROWS_AS(vessel::run_off({}, leg), Error);
    leg = right_leg();
    leg.fibula_top = leg.tibia_top, leg.fibula_bottom = leg.tibia_bottom;
    CHECK_THROWS_AS(vessel::run_off({}, leg), Error);
}
