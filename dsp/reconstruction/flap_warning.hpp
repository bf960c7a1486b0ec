// SPDX-License-Identifier: Apache-2.0
// Warnings about a flap.
#pragma once

#include "dsp/reconstruction/flap.hpp"
#include "dsp/rope/obstacle.hpp"

#include <string>
#include <vector>

namespace tactus::reconstruction {

enum class FlapTrouble {
    near_cut,        ///< object: a screw or implant
    near_vessel,     ///< object: a plate, screw or implant
    near_hardware,   ///< objects: plates, screws, implants
    outside_bone,    ///< a screw or implant outside of the bone
    leaves_bone,     ///< a screw or implant whose tip protrudes
    perforator_on_cut,
    perforator_lost,  ///< its bone is in a discarded wedge
    paddle_without_perforator,
    tumour_margin,
    no_artery,
    no_vein,
    no_site,
    no_pedicle,  ///< the vessel does not leave the kept bone at the knee
    too_short,   ///< reaches no site
    stretched,   ///< by more than in the leg
    kinked,
    twisted,
    span_stretched  ///< between two segments
};
const char* name_of(FlapTrouble trouble);  ///< "near-cut", ...

struct FlapWarning {
    FlapTrouble code = FlapTrouble::near_cut;
    std::string text;
    std::string object, other;  ///< the objects concerned; other: ""
    double number = 0.0;  ///< the compared value: m, rad, or a strain
};

/// Returns warnings of screws and implants that do not hold in `bone` (frame of the jaw): those outside of it, and
/// those whose tip protrudes by more than `max_standing_out`; FlapWarning::number is the length. The axis is sampled
/// every 0.25 mm.
std::vector<FlapWarning> hardware_warnings(const Flap& flap, const rope::Obstacle& bone);

/// m: a bicortical screw protrudes a little by design. A placeholder, without a source.
inline constexpr double max_standing_out = 1.5e-3;

}  // namespace tactus::reconstruction
