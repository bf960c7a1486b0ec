// SPDX-License-Identifier: Apache-2.0
// Assembles a whole case: poses of fragments, their order, and the fragments without a reliable fit.
#pragma once

#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/analysis/plan/plan_overlaps.hpp"

#include <utility>
#include <vector>

namespace tactus::analysis {

/// Residual of a fragment in an assembly, over all its faces in contact with others.
struct FragmentResidual {
    double rms = 0.0;  ///< m
    double area = 0.0;  ///< m² of its paint
    int faces = 0;  ///< pairs of faces
};

struct PlanAssembly {
    std::vector<Pose> poses;  ///< of all fragments
    /// Fits in the order of their steps: each fragment is placed on a partner that has already been placed. A fragment
    /// that a valid fit already holds there has none.
    std::vector<PlanMatch> placed;
    /// Shown fragments that were not placed and have no fit to the first part, each with its best rejected match; its
    /// partner is none if no match was close to a fit.
    std::vector<PlanMatch> stays;
    /// Per entry of `stays`: its faces may fit a part, but nothing was tried because both are locked.
    std::vector<bool> is_locked_apart;
    /// The connected parts of the shown fragments. The fixed one is first: the locked fragments, otherwise the largest
    /// connected part of the plan, otherwise the part with the most fragments, of which the largest.
    std::vector<std::vector<int>> parts;
    std::vector<FragmentResidual> residuals;  ///< per fragment
    std::vector<PlanOverlap> overlaps;  ///< shown fragments that overlap at the end
};

/// Tries every pair of faces of different fragments with all rotations. The most reliable pairs connect first. A part
/// that connects to a larger one moves to it with all its faces, if it fits, overlaps no fragment of it, and no other
/// pose for the same face fits nearly as well. Rejected pairs are tried again with the resulting parts. A pair rejected
/// because of a possible kerf is accepted if no kerf was given and the contours of all pairs together exclude one
/// (fit::CommonOpening). Finally all faces of a part are fitted together (dsp/fit/joint_refinement.hpp). In each part
/// some fragments do not move: the locked ones; otherwise one of the largest connected part of the plan; otherwise the
/// largest. `fits`: the plan's, per fragment; their connections are kept. Deterministic.
PlanAssembly assemble(PlanMatching& matching, const fit::Arrangement& arrangement,
                      const std::vector<std::optional<plan::PlanFit>>& fits);

}  // namespace tactus::analysis
