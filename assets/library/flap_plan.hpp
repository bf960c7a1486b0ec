// SPDX-License-Identifier: Apache-2.0
// The bundled reconstruction: the synthetic flap cut as planned, and the script of a hand that puts it together.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/cases/case_plan.hpp"
#include "assets/library/flap_case.hpp"
#include "assets/reconstruct/reconstruction.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::library {

struct FlapPieces {
    std::vector<bone::Bone> bones;  ///< jaw-1, jaw-2, resected, segment-1, …; each with points, its cuts labelled
    std::vector<Pose> planned;      ///< of each, from its file
    std::vector<Pose> table;        ///< where each lies when the hand begins
    bone::Bone tumour;              ///< with points; in the frame of the jaw
    std::string script;             ///< of the hand, for the driver 'scripted'
    double seconds = 0.0;           ///< of the script
    int moves = 0;                  ///< lines of the script
};

/// Cuts jaw and fibula by the inputs' planes. On the table the segments lie in a row as they were cut, the middle one
/// parallel to its place and 55 mm in front of it. The hand comes from the right stump, is stopped by the margin of the
/// tumour, and lifts out the resected piece; it folds the first segment
/// against the second and both against the third, and joins them; it brings them into the gap; it sews the vessels, and
/// pulls the jaw's new part forward against them. Deterministic. Throws Error as plan_fibula and cut_between do.
FlapPieces cut_flap(const FlapCase& made);

/// What `plan reconstruct` would keep of the case; its meshes are "fibula.stl", "jaw.stl" and "tumour.stl" with these
/// hashes.
reconstruct::Reconstruction reconstruction_of(const FlapCase& made, const std::array<std::uint64_t, 3>& hashes);

/// The plan with one file per piece: alternative 'main' has the planned places, 'table', the current one, where the
/// pieces lie at first. The jaw's pieces are locked in both. Each begins with the reconstruction.
cases::CasePlan plan_of(const FlapPieces& pieces, const std::vector<std::string>& files,
                        const std::vector<std::uint64_t>& hashes, const reconstruct::Reconstruction& all);

}  // namespace tactus::library
