// SPDX-License-Identifier: Apache-2.0
// Limits of the search hold in the result, and a track that cannot be a vessel as a whole says so.
#include "dsp/core/constants.hpp"
#include "dsp/simulate/vessel_cases.hpp"
#include "dsp/simulate/vessel_phantom.hpp"
#include "dsp/vessel/track_doubts.hpp"
#include "dsp/vessel/tracker.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

using namespace tactus;

namespace {

double widest(const vessel::Track& track) {
    double most = 0.0;
    for (const vessel::Branch& branch : track.branches) {
        for (const vessel::Node& node : branch.nodes) most = std::max(most, node.radius);
        if (branch.stenosis) most = std::max(most, branch.stenosis->reference_radius);
    }
    return most;
}

/// Half a circle of 55 mm radius, as an aortic arch, in samples of 2.5 mm. `radius`: of the vessel, m.
struct Arch {
    std::vector<Vec3> line;
    volume::Grid scan;

    Arch(double radius, double noise, std::uint64_t seed) {
        const double voxel = 2.5 * mm;
        simulate::VesselPhantom phantom({76, 32, 64}, voxel);
        const Vec3 middle = phantom.layout().position(38, 16, 12);
        for (double turn = 0.0; turn <= pi; turn += 0.3 * mm / (55.0 * mm))
            line.push_back(middle + 55.0 * mm * Vec3(std::cos(turn), 0.0, std::sin(turn)));
        phantom.add_lumen(line, [&](double) { return radius; }, 1.0);
        scan = phantom.scan(0.0, noise, seed);
    }
    const Vec3& seed() const { return line[line.size() / 3]; }
};

}  // namespace

TEST_CASE("no radius of a track or of its narrowings is above the limit of the search", "[slow]") {
    const simulate::VesselCase helix = simulate::helix_case(4.0, 0.3, 1), narrow = simulate::stenosis_case({}, 2, 0.3);
    const Arch arch(8.0 * mm, 0.2, 3);
    for (const double limit : {3.0, 5.0, 9.0}) {
        CAPTURE(limit);
        vessel::TrackSettings settings;
        settings.max_radius = limit * mm;
        settings.branches = false;
        const double most = settings.max_radius + 1e-12;
        CHECK(widest(vessel::follow(helix.scan, helix.seed, settings).track) <= most);
        CHECK(widest(vessel::follow(narrow.scan, narrow.seed, settings).track) <= most);
        CHECK(widest(vessel::follow(arch.scan, arch.seed(), settings).track) <= most);
    }
}

TEST_CASE("an arch of up to 25 mm radius is followed along its axis and doubted by nothing", "[slow]") {
    for (const double radius : {8.0, 15.0, 25.0}) {
        CAPTURE(radius);
        const Arch arch(radius * mm, 0.2, 5);
        vessel::TrackSettings settings;
        settings.max_radius = 32.0 * mm;
        settings.branches = false;
        const vessel::Followed found = vessel::follow(arch.scan, arch.seed(), settings);
        INFO(found.why);
        REQUIRE(found.track.branches.size() == 1);
        CHECK(found.track.doubts.empty());
        std::vector<double> radii;
        double squared = 0.0, count = 0.0;
        for (const vessel::Node& node : found.track.branches[0].nodes) {
            double nearest = 1.0;
            for (const Vec3& p : arch.line) nearest = std::min(nearest, glm::length(p - node.position));
            // Round flat ends the axis is not that of the vessel.
            const double from_end =
                std::min(glm::length(node.position - arch.line.front()), glm::length(node.position - arch.line.back()));
            if (from_end < 2.0 * radius * mm) continue;
            squared += nearest * nearest;
            count += 1.0;
            radii.push_back(node.radius / mm);
        }
        REQUIRE(radii.size() > 3);
        std::ranges::sort(radii);
        CHECK(radii[radii.size() / 2] == Approx(radius).epsilon(0.05));
        // A window as long as the vessel is wide cuts the corner of the arch.
        CHECK(std::sqrt(squared / count) < (0.5 + 0.07 * radius) * mm);
    }
}

TEST_CASE("a vessel that opens into a wide chamber is not followed into it", "[slow]") {
    for (const std::uint64_t seed : {3u, 4u}) {
        CAPTURE(seed);
        simulate::VesselPhantom phantom({48, 48, 90}, 1.0 * mm);
        const Vec3 low = phantom.layout().position(24, 24, 6), high = phantom.layout().position(24, 24, 60);
        phantom.add_lumen(simulate::straight(low, high, 0.15 * mm), [](double) { return 3.0 * mm; }, 1.0);
        const Vec3 chamber = phantom.layout().position(24, 24, 70);
        phantom.add_body([&](const Vec3& p) { return glm::length(p - chamber) < 15.0 * mm; }, 1.0);
        const volume::Grid scan = phantom.scan(0.0, 0.2, seed);
        const vessel::Followed found = vessel::follow(scan, phantom.layout().position(24, 24, 25));
        REQUIRE_FALSE(found.track.branches.empty());
        for (const vessel::Node& node : found.track.branches[0].nodes) {
            CHECK(node.radius < 7.0 * mm);
            CHECK(node.position.z < chamber.z);
        }
    }
}

TEST_CASE("a track in a plateau, where nothing is a wall, is doubted", "[slow]") {
    // A track that was forced through an even plateau, beside one in a vessel.
    simulate::VesselPhantom phantom({60, 40, 60}, 1.0 * mm);
    const Vec3 low = phantom.layout().position(40, 20, 4), high = phantom.layout().position(40, 20, 56);
    phantom.add_lumen(simulate::straight(low, high, 0.15 * mm), [](double) { return 4.0 * mm; }, 1.0);
    phantom.add_body([&](const Vec3& p) { return p.x < phantom.layout().position(28, 0, 0).x; }, 1.0);
    const volume::Grid scan = phantom.scan(0.0, 0.1, 9);
    const auto track_at = [&](int i) {
        vessel::Track track;
        track.contrast = 1.0;
        vessel::Branch branch;
        for (int k = 8; k < 52; ++k) {
            vessel::Node node;
            node.position = phantom.layout().position(i, 20, k);
            node.direction = Vec3(0.0, 0.0, 1.0);
            node.radius = 4.0 * mm;
            node.along = (k - 8) * mm;
            branch.nodes.push_back(node);
        }
        track.branches.push_back(branch);
        return track;
    };
    const vessel::Scan seen(scan);
    CHECK(vessel::doubts_of(seen, track_at(40), 20.0 * mm).empty());
    const std::vector<std::string> doubts = vessel::doubts_of(seen, track_at(14), 20.0 * mm);
    REQUIRE(doubts.size() == 1);
    CHECK(doubts[0] == "branch 0 has no wall: what is around it is as bright as what is in it, on 100 % of its length");
    CHECK(vessel::doubts_of(seen, track_at(40), 4.1 * mm).size() == 1);
    vessel::Track jumping = track_at(40);
    for (std::size_t n = 0; n < jumping.branches[0].nodes.size(); ++n)
        jumping.branches[0].nodes[n].radius = (n / 3 % 2 == 0 ? 4.0 : 2.0) * mm;
    CHECK_FALSE(vessel::doubts_of(seen, jumping, 20.0 * mm).empty());
}

TEST_CASE("a branch that ends where it is not told from noise is nowhere quite sure", "[slow]") {
    int ends = 0;
    for (const double noise : {0.7, 1.0})
        for (const std::uint64_t seed : {1u, 2u}) {
            const simulate::VesselCase one = simulate::ends_case(2.5, noise, seed);
            for (const vessel::Branch& branch : vessel::follow(one.scan, one.seed).track.branches)
                for (const vessel::Node& node : branch.nodes) {
                    const bool is_noise =
                        branch.end == vessel::End::noise || (branch.parent < 0 && branch.start == vessel::End::noise);
                    ends += is_noise;
                    if (is_noise) CHECK(node.confidence <= 0.9);
                }
        }
    CHECK(ends > 0);
}
