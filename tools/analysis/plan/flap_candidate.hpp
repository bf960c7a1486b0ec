// SPDX-License-Identifier: Apache-2.0
// Converts a candidate of the ranking to an alternative of the plan.
#pragma once

#include "dsp/reconstruction/ranking.hpp"
#include "tools/analysis/plan/plan_reconstruct.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace tactus::analysis {

struct TakenCandidate {
    MadeReconstruction made;
    reconstruction::Candidate candidate;
};

/// Ranks the reconstruction of the plan's current state and makes candidate `number` (from 1, best first) an
/// alternative with its own pieces, as make_reconstruction does. For the mirrored leg, the donor's surface is written
/// to "NAME-ALTERNATIVE-donor.stl" beside the plan. Throws Error for an excluded candidate, for a file that exists, and
/// as FlapStudy and make_reconstruction do; then no file is left.
TakenCandidate take_candidate(const std::filesystem::path& plan, std::size_t number, const std::string& alternative);

}  // namespace tactus::analysis
