// SPDX-License-Identifier: Apache-2.0
// The two stories of Olsson 2015, 6.1.3.1: a plate that meets the vessel, and vessels that do not reach.
#include "dsp/reconstruction/ranking.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/reconstruction/donor_bone.hpp"
#include "dsp/reconstruction/plate_line.hpp"
#include "tests/dsp/reconstruction/small_flap.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <numbers>

using namespace tactus;
using namespace tactus::reconstruction;

namespace {

bool has_trouble(const FlapMeasures& m, FlapTrouble code) {
    return std::ranges::any_of(m.warnings, [&](const FlapWarning& w) { return w.code == code; });
}

std::vector<Candidate> ranking(const FibulaInputs& in, const Flap& flap) {
    const rope::Cylinder donor(in.line_point, Vec3(0.0, 0.0, 1.0), 7 * mm);
    return ranked(in, flap, {{}, &donor, {}});
}

const Candidate& given(const std::vector<Candidate>& all) { return *std::ranges::find(all, 0, &Candidate::changes); }

// The vessels lie outwards (roll 90 degrees: what was below comes to the front), where the plate is, or inwards.
Flap with_plate(FibulaInputs& in, double roll) {
    in.roll = roll;
    Flap flap = small_flap();
    // The vein of the neck lies on that side of its artery on which the inward vessels have theirs.
    flap.sites[1].at.x -= 6 * mm;
    flap.plates = {plate_on(in, plan_fibula(in))};
    flap.plates[0].name = "plate";
    return flap;
}

}  // namespace

TEST_CASE("a plate on the vessels is raised, and the fibula turned by 180° about its axis is ranked first") {
    for (const double outwards : {-pi / 2.0, pi / 2.0}) {
        FibulaInputs in = small_inputs();
        const Flap flap = with_plate(in, outwards);
        const std::vector<Candidate> all = ranking(in, flap);
        REQUIRE(all.size() == 8);
        const bool meets = has_trouble(given(all).measures, FlapTrouble::near_vessel);
        // One of the two directions turns the vessels to the plate: there the turned fibula is better, and at the other
        // one, the control without the fault, nothing is raised and the plan as given stays first.
        if (meets) {
            CHECK(all[0].changes == 1);
            CHECK(all[0].is_flipped);
            CHECK(all[0].excluded.empty());
            CHECK_FALSE(has_trouble(all[0].measures, FlapTrouble::near_vessel));
        } else {
            CHECK(all[0].changes == 0);
        }
        CHECK(meets == (outwards < 0.0));
    }
}

TEST_CASE(
    "a reversed fibula whose vessels do not reach is excluded with the reason, and the other end is ranked first") {
    for (const bool reversed : {true, false}) {
        FibulaInputs in = small_inputs();
        in.reversed = reversed;
        Flap flap = small_flap();
        // A pedicle of about 65 mm: enough at the side of the sites, too short from the other end of the jaw.
        for (FlapVessel& vessel : flap.vessels) vessel.points.erase(vessel.points.begin(), vessel.points.begin() + 20);
        const std::vector<Candidate> all = ranking(in, flap);
        CHECK_FALSE(all[0].at_first);
        CHECK(all[0].changes == (reversed ? 2 : 0));
        CHECK(all[0].excluded.empty());
        CHECK_FALSE(has_trouble(all[0].measures, FlapTrouble::too_short));
        CHECK(has_trouble(given(all).measures, FlapTrouble::too_short) == reversed);
        if (reversed) CHECK_THAT(given(all).excluded, Catch::Matchers::ContainsSubstring("does not reach"));
        // All that leave at the first plane are excluded, and stand last.
        for (std::size_t n = 0; n < 8; ++n) {
            CHECK(all[n].excluded.empty() == !all[n].at_first);
            CHECK(all[n].at_first == (n >= 4));
        }
    }
}

TEST_CASE("a candidate that cannot be cut is excluded with the reason, and the other leg is the mirror image") {
    FibulaInputs in = small_inputs();
    in.along_line = {200 * mm, 250 * mm};
    in.farthest_from_line = 15 * mm;
    const Flap flap = small_flap();
    const std::vector<Candidate> all = ranking(in, flap);
    const auto other = std::ranges::find(all, 4, &Candidate::changes);
    CHECK(other->is_mirrored);
    CHECK(other->leg == Leg::right);
    CHECK(other->inputs.line_point.x == -in.line_point.x);
    // A mirrored leg has the same pedicle.
    CHECK(other->measures.reaches[0].in_situ == Approx(given(all).measures.reaches[0].in_situ).epsilon(1e-6));
    // Two segments of 41 mm do not fit above 300 mm.
    in.along_line = {250 * mm, 300 * mm};
    const std::vector<Candidate> high = ranking(in, flap);
    CHECK_THAT(given(high).excluded, Catch::Matchers::ContainsSubstring("misses the donor"));
    CHECK(given(high).plan.segments.empty());
}

TEST_CASE("a donor that is prepared once gives the plans that one prepared anew gives") {
    FibulaInputs in = small_inputs();
    const DonorBone donor(in);
    for (const bool is_reversed : {false, true})
        for (const double roll : {0.0, 1.0, 3.0}) {
            in.reversed = is_reversed;
            in.roll = roll;
            in.planes[1].origin.z += 0.3 * milli;
            const FibulaPlan anew = plan_fibula(in);
            FibulaInputs without = in;
            without.donor.reset();
            const FibulaPlan once = plan_fibula(without, donor);
            REQUIRE(once.segments.size() == anew.segments.size());
            for (std::size_t n = 0; n < once.segments.size(); ++n) {
                CHECK(once.segments[n].donor_to_target.position == anew.segments[n].donor_to_target.position);
                CHECK(once.segments[n].length_shortest == anew.segments[n].length_shortest);
                CHECK(once.segments[n].area == anew.segments[n].area);
            }
            CHECK(once.clearances == anew.clearances);
            CHECK(once.left_proximal == anew.left_proximal);
        }
}
