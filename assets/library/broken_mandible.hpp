// SPDX-License-Identifier: Apache-2.0
// The bundled case: the bundled mandible broken into twelve fragments, scanned and laid out, and the script of a hand
// that assembles it.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/plan/case_plan.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace tactus::library {

struct BrokenMandibleOptions {
    int pieces = 12;
    std::uint64_t seed = 1;
    double chips = 0.15;  ///< fraction of each fracture's area
    double kerf = 0.0;  ///< m
    int missing = 0;  ///< number of smallest fragments to omit
    double distance = 100e-3;  ///< m, distance of the laid-out fragments from the bone
    double rotation = 0.5;  ///< rad, rotation of the laid-out fragments
    double error = 5e-3,
           error_turn = 0.17453292519943295;  ///< m, rad: position error of the hand in front of a piece's place
};

struct BrokenMandible {
    std::vector<bone::Bone> fragments;  ///< as scanned, with painted fractures; the first is at its true pose
    std::vector<Pose> truth;  ///< per fragment: p_bone = R p_fragment + t
    std::vector<std::size_t> order;  ///< order of assembly of the fragments connected with the first
    /// Groups of fragments that missing ones disconnect from the first: for each group its base fragment, then the
    /// others in order of assembly. A group of one fragment touches no other.
    std::vector<std::vector<std::size_t>> islands;
    std::vector<Pose> beside;  ///< per fragment: pose near its target where the hand stops
    std::string script;  ///< script of the hand, for the driver 'scripted'
    double seconds = 0.0;  ///< duration of the script, s
};

/// Breaks `bone` and creates the case. The hand takes each fragment, stops at the position error from its target in a
/// seeded direction, snaps, settles and releases; then it settles each fragment twice more on all its neighbours. The
/// ground truth is used only for the stop position. Deterministic. Throws Error as break_bone does, and if a fragment
/// touches no other although none is missing.
BrokenMandible break_mandible(const bone::Bone& bone, const BrokenMandibleOptions& options = {});

/// The plan of the case as scanned, with one file per fragment; the first fragment is locked.
plan::CasePlan plan_of(const BrokenMandible& broken, const std::vector<std::string>& files,
                       const std::vector<std::uint64_t>& hashes);

}  // namespace tactus::library
