// SPDX-License-Identifier: Apache-2.0
// A break across which bone may be lost: the place is right, and its bound includes what may be lost.
#include "dsp/core/constants.hpp"
#include "tests/dsp/fit/broken_bar.hpp"
#include "tests/support/catch.hpp"
#include "tools/analysis/plan/plan_matching.hpp"

#include <glm/geometric.hpp>

#include <optional>
#include <utility>
#include <vector>

using namespace tactus;

namespace {

/// Halves of a bar that was broken nearly square across it, one of them scanned elsewhere.
analysis::PlanMatch match_of_square_break(std::optional<double> given) {
    const test::Relief rough = test::rough_relief(3, 0.3 * mm);
    const auto relief = [&rough](double y, double z) { return rough(y, z) + 0.004 * y; };
    const Vec3 scanned(4.0 * mm, 2.0 * mm, 0.0);
    std::vector<analysis::CaseFragment> fragments;
    for (const double side : {-1.0, 1.0}) {
        test::Half half = test::bar_half(side, relief, {.far = side > 0.0 ? scanned : Vec3(0.0)});
        analysis::CaseFragment loaded;
        loaded.bone.points = std::move(half.points);
        loaded.was_painted = true;
        loaded.map = contact::make_voxmap(std::move(half.distance));
        fragments.push_back(std::move(loaded));
    }
    analysis::PlanMatching matching(std::move(fragments), analysis::FitWay{given});
    const fit::Arrangement arrangement(2);
    return matching.near(arrangement, 1, analysis::Partners::all);
}

}  // namespace

TEST_CASE("a fit across which bone may be lost is uncertain, and its bound includes the loss", "[slow]") {
    const analysis::PlanMatch known = match_of_square_break(0.0), open = match_of_square_break(std::nullopt);
    CHECK(known.match.verdict == fit::FitVerdict::fit);
    REQUIRE(open.kerf);
    CAPTURE(open.kerf->kerf / mm, open.kerf->spread / mm, open.match.bound.face / mm);
    REQUIRE(open.kerf->is_open);
    CHECK(open.match.verdict == fit::FitVerdict::uncertain);
    CHECK(glm::length(open.match.pose.position - known.match.pose.position) < 1e-9);
    const double loss = open.kerf->loss;
    CHECK(loss > 0.5 * mm);
    CHECK(open.match.bound.face >= loss);
    CHECK(open.match.bound.far >= loss);
    CHECK(open.match.bound.face < loss + known.match.bound.face);
    CHECK(open.match.bound.turn == known.match.bound.turn);
}
