// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/tracker.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/simulate/vessel_cases.hpp"
#include "dsp/simulate/vessel_phantom.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

using namespace tactus;
using simulate::TrackError;
using simulate::VesselCase;

namespace {

struct Result {
    vessel::Followed found;
    TrackError error;
};

Result followed(const VesselCase& one) {
    Result result{vessel::follow(one.scan, one.seed), {}};
    INFO(one.name << " " << result.found.why);
    REQUIRE_FALSE(result.found.track.branches.empty());
    result.error = simulate::compared(result.found.track, one);
    return result;
}

}  // namespace

TEST_CASE("a helix of one to four voxels radius is followed to its ends within a quarter of a voxel", "[slow]") {
    for (const double radius : {1.0, 1.5, 2.5, 4.0}) {
        CAPTURE(radius);
        const Result result = followed(simulate::helix_case(radius, 0.2, 11));
        CHECK(result.error.rms < 0.25);
        CHECK(result.error.covered > 0.97);
        CHECK(result.found.track.branches.size() == 1);
        if (radius >= 1.5) CHECK(std::abs(result.error.mean_radius / radius - 1.0) < 0.05);
        else CHECK(result.found.track.branches[0].nodes[60].is_radius_uncertain);
    }
}

TEST_CASE("a track ends within two radii of the end of its vessel", "[slow]") {
    for (const double radius : {1.5, 2.5, 4.0})
        for (const std::uint64_t seed : {1u, 2u}) {
            CAPTURE(radius, seed);
            const Result result = followed(simulate::ends_case(radius, 0.4, seed));
            CHECK(result.error.overshoot < 2.0);
            CHECK(result.error.covered > 0.9);
            CHECK(result.error.worst < 1.5 * radius);
        }
}

TEST_CASE("both branches of a fork are found and meet near it", "[slow]") {
    for (const double ratio : {1.0, 0.5})
        for (const double angle : {30.0, 60.0, 90.0}) {
            CAPTURE(ratio, angle);
            const Result result = followed(simulate::branch_case(4.0, angle, ratio, 3));
            CHECK(result.found.track.branches.size() <= 3);  // a trunk that forks is a branch of its own
            CHECK(result.error.covered > 0.95);
            CHECK(result.error.joint < 1.5);
        }
}

TEST_CASE("a stenosis is passed and measured") {
    const VesselCase one = simulate::stenosis_case(4.0, 5);
    const Result result = followed(one);
    CHECK(result.error.covered > 0.95);
    const auto stenosis = vessel::stenosis_of(result.found.track.branches[0]);
    REQUIRE(stenosis);
    CHECK(stenosis->percent > 55.0);
    CHECK(stenosis->percent < 85.0);
    CHECK(std::abs(stenosis->reference_radius - one.radius) < 0.05 * one.radius);
    CHECK(stenosis->is_uncertain);  // 1.2 voxels
    const std::vector<Vec3>& line = one.lines[0];
    CHECK(glm::length(result.found.track.branches[0].nodes[stenosis->node].position - line[line.size() * 6 / 10]) <
          one.radius);
}

TEST_CASE("a stenosis too short for its window is called uncertain, one of four radii is measured", "[slow]") {
    for (const double radius : {3.0, 4.0})
        for (const double length : {2.0, 4.0}) {
            CAPTURE(radius, length);
            simulate::VesselPhantom phantom({40, 40, 90}, 1e-3);
            const std::vector<Vec3> line =
                simulate::straight(Vec3(20.2, 17.1, 8) * 1e-3, Vec3(19.1, 22.3, 82) * 1e-3, 1e-4);
            const double whole = glm::length(line.back() - line.front()), part = length * radius * 1e-3;
            phantom.add_tube(
                line,
                [&](double s) {  // by half
                    const double x = (s - 0.6) * whole / part;
                    const double narrower =
                        std::abs(x) < 0.5 ? 0.25 * (1.0 + std::cos(2.0 * std::numbers::pi * x)) : 0.0;
                    return radius * 1e-3 * (1.0 - narrower);
                },
                1.0);
            const volume::Grid scan = phantom.scan(0.0, 0.2, 101);
            const vessel::Followed found = vessel::follow(scan, line[line.size() / 4]);
            REQUIRE_FALSE(found.track.branches.empty());
            const auto stenosis = vessel::stenosis_of(found.track.branches[0]);
            REQUIRE(stenosis);
            CHECK(stenosis->is_uncertain == (length == 2.0));
            if (length == 4.0) CHECK(std::abs(stenosis->percent - 50.0) < 10.0);
        }
}

TEST_CASE("an even side branch is no stenosis, and no contrast is missed at its root", "[slow]") {
    for (const double ratio : {0.5, 0.6})
        for (const double angle : {45.0, 60.0}) {
            CAPTURE(ratio, angle);
            const Result result = followed(simulate::branch_case(2.5, angle, ratio, 4));
            REQUIRE(result.found.track.branches.size() == 2);
            const vessel::Branch& side = result.found.track.branches[1];
            CHECK(side.free_from > 2.5e-3);
            CHECK(side.free_from < 0.6 * side.length());
            if (const auto stenosis = vessel::stenosis_of(side)) CHECK(stenosis->percent < 15.0);
            CHECK(side.lost().empty());
        }
}

TEST_CASE("a single node without contrast is no lost stretch") {
    vessel::Branch branch;
    for (int n = 0; n < 10; ++n) {
        vessel::Node node;
        node.along = 1e-3 * n;
        node.is_lost = n == 2 || n == 5 || n == 6;
        branch.nodes.push_back(node);
    }
    REQUIRE(branch.lost().size() == 1);
    CHECK(branch.lost()[0].from == Approx(5e-3));
    CHECK(branch.lost()[0].to == Approx(6e-3));
}

TEST_CASE("a gap without contrast is bridged and said", "[slow]") {
    for (const double radius : {1.5, 3.0}) {
        CAPTURE(radius);
        const VesselCase one = simulate::gap_case(radius, 7);
        const Result result = followed(one);
        CHECK(result.error.covered > 0.95);
        const std::vector<vessel::LostStretch> lost = result.found.track.branches[0].lost();
        REQUIRE_FALSE(lost.empty());
        for (const vessel::Node& node : result.found.track.branches[0].nodes)
            if (node.is_lost) CHECK(node.confidence == 0.0);
    }
}

TEST_CASE("a wall of bone half a voxel away does not capture the track", "[slow]") {
    for (const double radius : {1.5, 3.0}) {
        CAPTURE(radius);
        const Result result = followed(simulate::bone_case(radius, 9));
        CHECK(result.error.rms < 0.25);
        CHECK(result.error.covered > 0.95);
        CHECK(result.found.track.branches.size() == 1);
    }
}

TEST_CASE("no vessel is found in noise", "[slow]") {
    for (int n = 0; n < 10; ++n) {
        const volume::Grid grid =
            simulate::noise_case(n % 2 == 0 ? 0.0 : 0.7 + 0.08 * n, 100 + static_cast<std::uint64_t>(n));
        const Random random{static_cast<std::uint64_t>(n)};
        for (std::uint64_t k = 0; k < 4; ++k) {
            CAPTURE(n, k);
            const Vec3 seed = 1e-3 * Vec3(8.0 + 32.0 * random.uniform(3 * k), 8.0 + 32.0 * random.uniform(3 * k + 1),
                                          8.0 + 32.0 * random.uniform(3 * k + 2));
            const vessel::Followed found = vessel::follow(grid, seed);
            CHECK(found.track.branches.empty());
            CHECK_FALSE(found.why.empty());
        }
    }
}

TEST_CASE("the unit of brightness does not matter to a track", "[slow]") {
    VesselCase one = simulate::helix_case(2.0, 0.2, 4);
    const vessel::Followed before = vessel::follow(one.scan, one.seed);
    for (float& value : one.scan.values) value = 512.0f * value;  // exact in float
    const vessel::Followed after = vessel::follow(one.scan, one.seed);
    REQUIRE(before.track.branches.size() == after.track.branches.size());
    REQUIRE(before.track.branches[0].nodes.size() == after.track.branches[0].nodes.size());
    for (std::size_t n = 0; n < before.track.branches[0].nodes.size(); ++n)
        CHECK(glm::length(before.track.branches[0].nodes[n].position - after.track.branches[0].nodes[n].position) <
              1e-9);
}

TEST_CASE("a seed outside of the scan, without numbers or on bone is refused in one sentence") {
    const VesselCase one = simulate::bone_case(2.0, 9);
    CHECK_THROWS_AS(vessel::follow(one.scan, Vec3(-0.01, 0.02, 0.02)), Error);
    CHECK_THROWS_AS(vessel::follow(one.scan, Vec3(std::nan(""), 0.02, 0.02)), Error);
    vessel::TrackSettings settings;
    settings.exclude_above = 600.0;
    CHECK_THROWS_AS(vessel::follow(one.scan, Vec3(26.0, 19.9, 54.0) * 1e-3, settings), Error);
}
