// SPDX-License-Identifier: Apache-2.0
// What may be wrong with a flap.
#pragma once

#include "dsp/reconstruct/flap.hpp"
#include "dsp/rope/obstacle.hpp"

#include <string>
#include <vector>

namespace tactus::reconstruct {

enum class FlapTrouble {
    near_cut,        ///< a screw or implant
    near_vessel,     ///< a plate, screw or implant
    near_hardware,   ///< plates, screws, implants
    outside_bone,    ///< a screw or implant that meets no bone
    leaves_bone,     ///< a screw or implant whose tip stands out
    perforator_on_cut,
    perforator_lost,  ///< its bone is in a wedge
    paddle_without_perforator,
    tumour_margin,
    no_artery,
    no_vein,
    no_site,
    no_pedicle,  ///< the vessel does not leave the kept bone at the knee
    too_short,   ///< reaches no site
    stretched,   ///< more than in the leg
    kinked,
    twisted,
    span_stretched  ///< between two segments
};
const char* name_of(FlapTrouble trouble);  ///< "near-cut", ...

struct FlapWarning {
    FlapTrouble code = FlapTrouble::near_cut;
    std::string text;
    std::string object, other;  ///< what is meant; other: ""
    double number = 0.0;  ///< what was compared: m, rad, or a strain
};

/// Warnings of screws and implants that do not hold in `bone` (frame of the jaw): those that meet none, and those whose tip
/// stands out by more than `max_standing_out`, on which FlapWarning::number is how far. The axis is sampled every 0.25 mm.
std::vector<FlapWarning> hardware_warnings(const Flap& flap, const rope::Obstacle& bone);

/// m: a bicortical screw stands out a little by design. A placeholder, not from a source.
inline constexpr double max_standing_out = 1.5e-3;

}  // namespace tactus::reconstruct
