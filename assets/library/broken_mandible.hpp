// SPDX-License-Identifier: Apache-2.0
// The bundled case: the bundled mandible in twelve pieces, scanned, laid out, and a hand that puts it together.
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
    double chips = 0.15;        ///< share of each fracture's area
    double kerf = 0.0;          ///< m
    int missing = 0;            ///< so many of the smallest pieces are lost
    double distance = 100e-3;      ///< m, how far before the bone the pieces are laid out
    double rotation = 0.5;          ///< rad, how far they are turned
    double error = 5e-3, error_turn = 0.17453292519943295;  ///< m, rad: where the hand stops beside a piece's place
};

struct BrokenMandible {
    std::vector<bone::Bone> fragments;  ///< as scanned; painted where they broke; the first is in its place
    std::vector<Pose> truth;      ///< of each: p_bone = R p_fragment + t
    std::vector<std::size_t> order;  ///< in which those are put together that hang together with the first
    /// What lost pieces cut off from the first: of each part the piece that its others are brought to, and these in
    /// their order. A part of one touches none.
    std::vector<std::vector<std::size_t>> islands;
    std::vector<Pose> beside;  ///< of each: where the hand stops beside its place
    std::string script;  ///< of the hand, for the driver 'scripted'
    double seconds = 0.0;  ///< that the hand needs
};

/// Breaks `bone` and makes the case. The hand takes each piece, stops beside its place by the error in a seeded
/// direction, snaps, settles and lets go; then it takes each twice more where it lies and settles it on all its
/// neighbours. It knows the truth for no more than where to stop. Deterministic. Throws Error as break_bone does, and
/// when a piece touches none of the others although none is missing.
BrokenMandible break_mandible(const bone::Bone& bone, const BrokenMandibleOptions& options = {});

/// The plan of the case as it is scanned, for fragments in files of their names; the first one is locked.
cases::CasePlan plan_of(const BrokenMandible& broken, const std::vector<std::string>& files,
                        const std::vector<std::uint64_t>& hashes);

}  // namespace tactus::library
