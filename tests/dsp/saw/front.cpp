// SPDX-License-Identifier: Apache-2.0
// The front of a saw in analytic blocks.
#include "dsp/saw/published.hpp"
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>

using namespace tactus;
using namespace tactus::test;

namespace {

struct Cut {
    double feed, volume;  // m/s, m³
};

/// Steady feed and volume under a constant thrust.
Cut cut_at(double thrust, double rate, double voxel, double density = 1800.0) {
    const auto bone = bone_block({.voxel = voxel, .density = density});
    Sawing sawing(*bone, rate);
    Pushing hand;
    hand.push(sawing, thrust, 1.5);
    const double z = hand.position.z, volume = sawing.removed;
    hand.push(sawing, thrust, 2.0);
    return {(z - hand.position.z) / 2.0, sawing.removed - volume};
}

/// Nodes that bear on a bone of that width: those in it and one beyond each end.
double feed_by_law(double thrust, double nodes, double density = 1800.0) {
    const saw::CuttingLaw law;
    const double pitch = 0.043 / 31.0, bearing = pitch / 0.003;
    return 2.0 * 228.0 * law.depth(thrust / (nodes * bearing) * 1800.0 / density).depth;
}

}  // namespace

TEST_CASE("feed follows thrust by the cutting law and pushing harder removes more") {
    double last = 0.0;
    for (const double thrust : {4.0, 7.5, 12.0, 20.0}) {
        const Cut cut = cut_at(thrust, 1000.0, 0.33e-3);
        CAPTURE(thrust, cut.feed, cut.volume, feed_by_law(thrust, 10.0));
        CHECK(cut.feed > 1.2 * last);
        CHECK(cut.feed == Approx(feed_by_law(thrust, 10.0)).epsilon(0.05));
        // In the first half of a kerf the round front is not in the bone with its whole width.
        if (thrust > 10.0) CHECK(cut.volume == Approx(cut.feed * 2.0 * 0.012 * 0.001).epsilon(0.02));
        last = cut.feed;
    }
}

TEST_CASE("the feed does not depend on the rate of the force nor on the voxel", "[slow]") {
    const Cut reference = cut_at(15.0, 1000.0, 0.25e-3);
    for (const double rate : {250.0, 500.0, 2000.0}) {
        const Cut cut = cut_at(15.0, rate, 0.25e-3);
        CAPTURE(rate, cut.feed, reference.feed, cut.volume, reference.volume);
        CHECK(cut.feed == Approx(reference.feed).epsilon(0.02));
        CHECK(cut.volume == Approx(reference.volume).epsilon(0.02));
    }
    for (const double voxel : {0.16e-3, 0.33e-3, 0.5e-3}) {
        const Cut cut = cut_at(15.0, 1000.0, voxel);
        CAPTURE(voxel, cut.feed, reference.feed, cut.volume, reference.volume);
        CHECK(cut.feed == Approx(reference.feed).epsilon(0.02));
        CHECK(cut.volume == Approx(reference.volume).epsilon(0.02));
    }
}
