// SPDX-License-Identifier: Apache-2.0
// Creates the plan of a case from the inputs of a fibula plan: pieces of jaw and fibula as fragments, each segment
// placed.
#pragma once

#include "assets/plan/case_plan.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"

#include <filesystem>
#include <string>

namespace tactus::analysis {

struct MadeReconstruction {
    plan::CasePlan plan;
    reconstruction::FibulaPlan fibula;
};

/// Cuts the donor at the planned planes and the jaw, if there is one, at the first and last of its planes. Writes the
/// pieces into "NAME-pieces" beside the plan (STL, mm, LPS) and saves a plan with these steps: one with the whole
/// reconstruction, one that hides the resected piece, and one per segment that places it. Bodies of the jaw of at most
/// 2 cm³, such as teeth, belong to the piece nearest to their centre; the rest of a body that a plane cuts belongs to
/// the jaw on its side. With `alternative` the plan must exist: the pieces go to "NAME-ALTERNATIVE-pieces", their names
/// end with the alternative's, and the steps begin at the plan as scanned.
/// Throws Error if there is no donor, if the plan (without `alternative`), the alternative or the folder exists, and as
/// plan_fibula, cut_between and load_fragment do; then no file is left.
MadeReconstruction make_reconstruction(const reconstruction::ReconstructionInputs& inputs,
                                       const std::filesystem::path& plan, const std::string& alternative = "");

}  // namespace tactus::analysis
