// SPDX-License-Identifier: Apache-2.0
// Puts a whole case together: which fragment goes where, in which order, and what stays because nothing is sure.
#pragma once

#include "tools/study/planning/plan_matching.hpp"
#include "tools/study/planning/plan_overlaps.hpp"

#include <utility>
#include <vector>

namespace tactus::study {

/// What holds a fragment of an assembly, over all its faces that lie on others.
struct FragmentResidual {
    double rms = 0.0;  ///< m
    double area = 0.0;  ///< m² of its paint
    int faces = 0;  ///< pairs of faces
};

struct PlanAssembly {
    std::vector<Pose> poses;  ///< of all fragments
    /// Fits in the order of their steps: each fragment goes to a partner that is in its place by then. A fragment that
    /// already lies there, by a fit that holds, has none.
    std::vector<PlanMatch> placed;
    /// Shown fragments that stay and that no fit connects to the first part, each with the best that was refused; its
    /// partner is none when nothing was near to a fit.
    std::vector<PlanMatch> stays;
    /// Per entry of `stays`: its faces may fit a part, and nothing was tried because both are locked.
    std::vector<bool> is_locked_apart;
    /// Of the shown fragments. The one that stands is first: what is locked, else the largest connected part of the
    /// plan, else the most fragments, of which the largest.
    std::vector<std::vector<int>> parts;
    std::vector<FragmentResidual> residuals;  ///< per fragment
    std::vector<PlanOverlap> overlaps;  ///< shown fragments that lie in each other in the end
};

/// Every pair of faces of different fragments is tried with all rotations. The surest pairs connect first; a part that
/// connects to a larger one moves to it, all its faces at once, when it fits, lies in no fragment of it, and no other
/// place for the same face fits nearly as well. What was refused is tried again with the parts that were made; what was
/// refused for a kerf that nobody told, when the contours of all pairs together exclude one (fit::CommonOpening). In the
/// end all faces of a part are fitted together (dsp/fit/joint_refinement.hpp). In each part one fragment stays where it
/// is: the locked ones; else one of the largest connected part of the plan; else the largest. `fits`: the plan's, per
/// fragment; their connections stay. Deterministic.
PlanAssembly assemble(PlanMatching& matching, const fit::Arrangement& arrangement,
                      const std::vector<std::optional<cases::PlanFit>>& fits);

}  // namespace tactus::study
