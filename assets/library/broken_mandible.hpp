// SPDX-License-Identifier: Apache-2.0
// The bundled case: the bundled mandible broken into twelve pieces, scanned and laid out, and the script of a hand that
// assembles it.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/cases/case_plan.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::library {

struct BrokenMandibleOptions {
    int pieces = 12;
    std::uint64_t seed = 1;
    double chips = 0.15;  ///< share of each fracture's area
    double kerf = 0.0;  ///< m
    int missing = 0;  ///< number of the smallest pieces that are lost
    double distance = 100e-3;  ///< m, distance of the laid-out pieces from the bone
    double rotation = 0.5;  ///< rad, rotation of the laid-out pieces
    double error = 5e-3,
           error_turn = 0.17453292519943295;  ///< m, rad: position error of the hand in front of a piece's place
};

struct BrokenMandible {
    std::vector<bone::Bone> fragments;  ///< as scanned, with painted fractures; the first is in place
    std::vector<Pose> truth;  ///< per fragment: p_bone = R p_fragment + t
    std::vector<std::size_t> order;  ///< order of assembly of the pieces connected with the first
    /// Parts that lost pieces disconnect from the first: for each part its base piece, then the others in order of
    /// assembly. A part of one piece touches no other.
    std::vector<std::vector<std::size_t>> islands;
    std::vector<Pose> beside;  ///< per fragment: where the hand stops near its place
    std::string script;  ///< script of the hand, for the driver 'scripted'
    double seconds = 0.0;  ///< duration of the script, s
};

/// Breaks `bone` and makes the case. The hand takes each piece, stops at the position error from its place in a seeded
/// direction, snaps, settles and releases; then it settles each piece twice more on all its neighbours. The ground
/// truth is used only for the stop position. Deterministic. Throws Error like break_bone, and when a piece touches no
/// other although none is missing.
BrokenMandible break_mandible(const bone::Bone& bone, const BrokenMandibleOptions& options = {});

/// The plan of the case as scanned, with one file per fragment; the first fragment is locked.
cases::CasePlan plan_of(const BrokenMandible& broken, const std::vector<std::string>& files,
                        const std::vector<std::uint64_t>& hashes);

}  // namespace tactus::library
