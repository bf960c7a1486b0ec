// SPDX-License-Identifier: Apache-2.0
// The ways in which a fibula can be put into a jaw, best first.
#pragma once

#include "dsp/reconstruct/fibula_plan.hpp"
#include "dsp/reconstruct/flap.hpp"
#include "dsp/reconstruct/reach.hpp"
#include "dsp/rope/obstacle.hpp"

#include <span>
#include <string>
#include <vector>

namespace tactus::reconstruct {

/// One of two legs × two ends at which the pedicle leaves × two faces turned outwards.
struct Candidate {
    FibulaInputs inputs;
    Leg leg = Leg::left;
    bool is_mirrored = false;  ///< the other leg than was given: the given one, reflected
    bool at_first = false;  ///< the pedicle leaves at the first plane of the jaw: the donor is reversed
    bool is_flipped = false;  ///< turned by 180° about its axis against what was given
    int changes = 0;  ///< weight of what differs from what was given: 1 turned, 2 reversed, 4 the other leg
    std::string excluded;  ///< why it cannot be; empty: it can
    FibulaPlan plan;       ///< empty when plan_fibula refuses it
    FlapMeasures measures;
};

/// What stays the same in all candidates.
struct RankingScene {
    std::span<const rope::Obstacle* const> jaw;  ///< what is kept of it, in its frame
    const rope::Obstacle* donor = nullptr;       ///< the donor as given, in its frame; may be null
    std::span<const Vec3> tumour;                ///< frame of the jaw
};

/// All eight, best first. A candidate is excluded when plan_fibula refuses it or an artery or vein reaches no site. The
/// others are ordered by: plates, screws or implants that meet vessels; the worst reach of artery and vein; kinks and
/// twists; other warnings; what differs from what was given; strain. Plates and implants stay where they are in the jaw.
/// Places along the line hold for the given direction; others begin as far from the ankle. The donor's surface is prepared once per leg. Allocates. Throws Error as DonorBone
/// does.
std::vector<Candidate> ranked(const FibulaInputs& inputs, const Flap& flap, const RankingScene& scene);

/// The given donor reflected at x = 0: the other leg of a symmetric body.
FibulaInputs other_leg(const FibulaInputs& inputs);
Flap other_leg(const Flap& flap);

}  // namespace tactus::reconstruct
