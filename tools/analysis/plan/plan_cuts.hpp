// SPDX-License-Identifier: Apache-2.0
// Cuts of a reconstruction derived from where its pieces were placed.
#pragma once

#include "dsp/reconstruction/placed_cuts.hpp"
#include "tools/analysis/plan/plan_reconstruct.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::analysis {

struct CutsOfPieces {
    std::vector<std::string> segments;  ///< names in the plan before
    reconstruction::FibulaPlan before;
    reconstruction::PlacedCuts cuts;
    MadeReconstruction made;
};

/// Derives the cuts from the current poses of the segments (reconstruction::cuts_of_placed) and adds the result to the
/// plan as an alternative with its own pieces, as make_reconstruction does. Plates, implants, vessels and limits are
/// those of the current state. Throws Error if there is no reconstruction, if a segment still lies in the leg, if a
/// piece of the jaw was moved, and as the functions named above; then the plan is unchanged.
CutsOfPieces cut_as_placed(const std::filesystem::path& plan, const std::string& alternative);

}  // namespace tactus::analysis
