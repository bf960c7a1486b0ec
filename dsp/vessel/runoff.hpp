// SPDX-License-Identifier: Apache-2.0
// Detects the three arteries of a lower leg on a track, and derives warnings for harvesting the fibula.
#pragma once

#include "dsp/vessel/track.hpp"

#include <array>
#include <string>
#include <vector>

namespace tactus::vessel {

enum class LegArtery { anterior_tibial, posterior_tibial, peroneal };
std::string_view name_of(LegArtery artery);

/// The axes of the tibia and the fibula of one leg, given by the user. LPS, m.
struct LegGeometry {
    bool is_right = false;
    Vec3 tibia_top{0.0}, tibia_bottom{0.0};    ///< middle of the plateau, middle of the ankle's surface
    Vec3 fibula_top{0.0}, fibula_bottom{0.0};  ///< head, tip of the lateral malleolus
};

/// State of one artery. Levels: 0 at the top of the tibia, 1 at its bottom.
struct SeenArtery {
    bool is_seen = false;
    double from = 0.0, to = 0.0;   ///< levels between which it is visible
    bool reaches_foot = false;     ///< visible below level 0.85; peroneal: 0.75, where it normally divides
    bool has_lost_stretch = false;
};

struct RunOff {
    std::array<SeenArtery, 3> arteries;  ///< in the order of LegArtery
    double from = 1.0, to = 0.0;         ///< levels that the track covers
    bool is_judged = false;              ///< the track covers levels 0.4 to 0.7
    std::vector<std::string> warnings;   ///< sentences for the person who plans
};

/// Identifies vessels by their position relative to the bones, in cross-sections between level 0.3 and the ankle.
/// Assumes that the leg is not malformed, that the axes are correct within about 5 mm, and this anatomy: the anterior
/// tibial artery lies in front of the plane through both bones; of those behind it, the peroneal artery lies closer to
/// the fibula and the posterior tibial artery closer to the tibia. An artery that was not tracked counts as not
/// visible, although it may be open. Not clinical advice. Throws Error if the axes are shorter than 100 mm or closer
/// than 10 mm, or if the fibula is not lateral on the given side.
RunOff run_off(const Track& track, const LegGeometry& leg);

}  // namespace tactus::vessel
