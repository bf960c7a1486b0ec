// SPDX-License-Identifier: Apache-2.0
// Chipped faces whose wide attraction leads away from the right place.
#include "assets/library/fibula.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tools/analysis/bone/fracture.hpp"
#include "tools/analysis/plan/plan_matching.hpp"

#include <glm/geometric.hpp>

#include <utility>
#include <vector>

using namespace tactus;

TEST_CASE("a chipped shaft that slips by seven degrees from every start is brought back, and its slip is named",
          "[slow]") {
    analysis::FractureSettings settings;
    settings.seed = 7002;
    settings.chips = 0.2;
    std::vector<analysis::CaseFragment> fragments;
    std::vector<Pose> place;
    analysis::break_and_scan(library::make_fibula(), settings, [&](analysis::ScannedFragment one) {
        analysis::CaseFragment loaded;
        loaded.bone = std::move(one.bone);
        loaded.was_painted = true;
        loaded.map = contact::make_voxmap(std::exchange(loaded.bone.distance, {}));
        fragments.push_back(std::move(loaded));
        place.push_back(one.place);
    });
    const Pose truth = place[0].inverse() * place[1];
    Vec3 face(0.0);
    double area = 0.0;
    for (const contact::SurfacePoint& p : fragments[1].bone.points)
        if (p.label == contact::surface_label::fracture) face += p.area * p.position, area += p.area;
    face /= area;
    analysis::PlanMatching matching(std::move(fragments));
    fit::Arrangement arrangement(2);
    arrangement.move(1, truth);
    const fit::FragmentMatch match = matching.near(arrangement, 1, analysis::Partners::all).match;
    const double turn = glm::length(rotation_between(truth.orientation, match.pose.orientation)),
                 error = glm::length(match.pose.apply(face) - truth.apply(face));
    INFO(fit::name_of(match.verdict) << ", " << turn / degree << " deg and " << error / mm << " mm");
    CHECK(turn < 0.5 * degree);
    CHECK(error < 0.05 * mm);
    CHECK(match.verdict == fit::FitVerdict::fit);
    // The slip is nearly as good.
    CHECK(match.bound.has_rival);
    CHECK(match.bound.turn > 5.0 * degree);
}
