// SPDX-License-Identifier: Apache-2.0
// What may be wrong with a flap.
#pragma once

#include <string>

namespace tactus::reconstruct {

enum class FlapTrouble {
    near_cut,        ///< a screw or implant
    near_vessel,     ///< a plate, screw or implant
    near_hardware,   ///< plates, screws, implants
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

}  // namespace tactus::reconstruct
