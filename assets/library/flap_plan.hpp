// SPDX-License-Identifier: Apache-2.0
// The bundled reconstruction: the synthetic flap cut as planned, and the script of a hand that assembles it.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/library/flap_case.hpp"
#include "assets/plan/case_plan.hpp"
#include "assets/reconstruction/reconstruction.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::library {

struct FlapPieces {
    std::vector<bone::Bone> bones;  ///< jaw-1, jaw-2, resected, segment-1, …; each with points, its cuts labelled
    std::vector<Pose> planned;      ///< of each, from its file
    std::vector<Pose> table;        ///< initial pose of each
    bone::Bone tumour;              ///< with points; in the frame of the jaw
    std::string script;             ///< of the hand, for the driver 'scripted'
    double seconds = 0.0;           ///< of the script
    int moves = 0;                  ///< lines of the script
};

/// Cuts jaw and fibula by the inputs' planes. On the table the segments lie in a row as they were cut, the middle one
/// parallel to its target and 55 mm in front of it. The hand comes from the right stump, is stopped by the margin of
/// the tumour, and lifts out the resected piece. Then it folds the first segment against the second and both against
/// the third, joins them, brings them into the gap, sews the vessels, and pulls the jaw's new part forward against
/// them. Deterministic. Throws Error as plan_fibula and cut_between do.
FlapPieces cut_flap(const FlapCase& made);

/// Returns the reconstruction that `plan reconstruct` would store for the case; its meshes are "fibula.stl", "jaw.stl"
/// and "tumour.stl" with these hashes.
reconstruction::Reconstruction reconstruction_of(const FlapCase& made, const std::array<std::uint64_t, 3>& hashes);

/// Returns the plan with one file per piece: alternative 'main' has the planned poses; 'table', the current one, has
/// the initial poses. The pieces of the jaw are locked in both. Each begins with the reconstruction.
plan::CasePlan plan_of(const FlapPieces& pieces, const std::vector<std::string>& files,
                       const std::vector<std::uint64_t>& hashes, const reconstruction::Reconstruction& all);

}  // namespace tactus::library
