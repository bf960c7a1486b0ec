// SPDX-License-Identifier: Apache-2.0
// Trials that tell true fits from false ones: pieces of broken bones against their neighbours, against pieces that only
// look alike, and against strangers. What they show sets the thresholds of dsp/fit/acceptance.hpp.
#pragma once

#include "dsp/fit/fit.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::bench {

/// A broken bone whose pieces are tried on each other, on mirrored ones, and on those of another broken bone.
struct PairGroup {
    bool is_jaw = true;  ///< else the fibula; the strangers come from the other one
    std::uint64_t seed = 1;
    double chips = 0.0;  ///< share of each fracture
    double voxel = 0.35e-3;  ///< m, of the scans
    bool is_proposed = false;  ///< the paint is a proposal from roughness; else it is exact
};

/// Group `number`: both bones, chips of 0, 10 and 20 %, two voxel sizes and both kinds of paint take turns.
PairGroup pair_group(int number);

/// m along the face: the longest wave of a simulated fracture (assets/plan/rough_surface.hpp), after which its relief looks
/// like itself.
inline constexpr double relief_period = 9e-3;

struct PairTrial {
    std::string
        kind;  ///< true, neighbour (a fracture of the same bone), mirrored, foreign, slipped (true, see relief_period)
    bool is_global = false;  ///< else from a start near the place, or near where it would look alike
    int moving = 0, partner = 0;
    fit::FitVerdict loose = fit::FitVerdict::no_match;  ///< without thresholds
    fit::FitVerdict verdict = fit::FitVerdict::no_match;  ///< with those of the program
    double score = 0.0, margin = 0.0, share = 0.0, overlap = 0.0, rms = 0.0;  ///< of the loose one; m², m
    double error = -1.0;  ///< m, rms at the painted face, of the loose one; negative: the pair belongs nowhere
    double verdict_error = -1.0;  ///< the same of the other
    bool has_rival = false;  ///< the bound of the other contains another place
    /// With the thresholds of the program but for Acceptance::max_far.
    fit::FitVerdict unheld = fit::FitVerdict::no_match;
    double held = 0.0;  ///< m, FitPrecision::far of that fit
    double far_error = -1.0;  ///< m, where its fragment is farthest from the face; negative as above
};

std::vector<PairTrial> try_pairs(const PairGroup& group);

}  // namespace tactus::bench
