// SPDX-License-Identifier: Apache-2.0
// From the inputs of a fibula plan to the plan of a case: pieces of jaw and fibula as fragments, each segment placed.
#pragma once

#include "assets/cases/case_plan.hpp"
#include "dsp/reconstruct/fibula_plan.hpp"

#include <filesystem>

namespace tactus::study {

struct Reconstruction {
    cases::CasePlan plan;
    reconstruct::FibulaPlan fibula;
};

/// Cuts the donor at the planned planes and the jaw, when there is one, at the first and last of its planes, writes the
/// pieces into "NAME-pieces" beside the plan (STL, mm, LPS) and saves a plan with a step that hides the resected piece
/// and one per segment that places it. Bodies of the jaw that no plane cuts and that are small (less than 1 %
/// of the triangles, such as teeth) go with the piece that is nearest to their middle. Throws Error when there is no donor, when the plan or the
/// folder exists, and as plan_fibula, cut_between and load_fragment do; then nothing is left behind.
Reconstruction make_reconstruction(const reconstruct::FibulaInputs& inputs, const std::filesystem::path& plan);

}  // namespace tactus::study
