// SPDX-License-Identifier: Apache-2.0
// Ranks the possible orientations of a fibula in a jaw.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"
#include "dsp/reconstruction/reach.hpp"
#include "dsp/rope/obstacle.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::reconstruction {

/// One combination of two legs × two ends at which the pedicle leaves × two faces turned outwards.
struct Candidate {
    FibulaInputs inputs;
    Leg leg = Leg::left;
    bool is_mirrored = false;  ///< the other leg than the given one: the given one, reflected
    bool at_first = false;  ///< the pedicle leaves at the first plane of the jaw: the donor is reversed
    bool is_flipped = false;  ///< rotated by 180° about its axis against the given roll
    int changes = 0;  ///< weight of the differences from the given plan: 1 rotated, 2 reversed, 4 the other leg
    std::string excluded;  ///< why it is impossible; empty: it is possible
    FibulaPlan plan;       ///< empty if plan_fibula rejects it
    FlapMeasures measures;
};

/// The inputs common to all candidates.
struct RankingScene {
    std::span<const rope::Obstacle* const> jaw;  ///< its remaining parts, in its frame
    const rope::Obstacle* donor = nullptr;       ///< the donor as given, in its frame; may be null
    std::span<const Vec3> tumour;                ///< frame of the jaw
};

/// Returns all eight, best first. A candidate is excluded if plan_fibula rejects it or if an artery or vein reaches no
/// site. The others are ordered by: plates, screws or implants that touch vessels; the worst reach of artery and vein;
/// kinks and twists; other warnings; differences from the given plan; strain. Plates and implants keep their positions
/// in the jaw. Given positions along the line apply to the given direction; other candidates begin at the same distance
/// from the ankle. The donor's surface is prepared once per leg. Allocates. Throws Error as DonorBone does.
std::vector<Candidate> ranked(const FibulaInputs& inputs, const Flap& flap, const RankingScene& scene);

/// Returns the given donor reflected at x = 0: the other leg of a symmetric body.
FibulaInputs other_leg(const FibulaInputs& inputs);
Flap other_leg(const Flap& flap);

}  // namespace tactus::reconstruction
