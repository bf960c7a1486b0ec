// SPDX-License-Identifier: Apache-2.0
// The three arteries of a lower leg on a track: which are seen, and what that means for taking the fibula.
#pragma once

#include "dsp/vessel/track.hpp"

#include <array>
#include <string>
#include <vector>

namespace tactus::vessel {

enum class LegArtery { anterior_tibial, posterior_tibial, peroneal };
std::string_view name_of(LegArtery artery);

/// The bones of one leg, given by the user: the ends of the tibia's and of the fibula's axis. LPS, m.
struct LegGeometry {
    bool is_right = false;
    Vec3 tibia_top{0.0}, tibia_bottom{0.0};    ///< middle of the plateau, middle of the ankle's surface
    Vec3 fibula_top{0.0}, fibula_bottom{0.0};  ///< head, tip of the lateral malleolus
};

/// What is known of one artery. Levels: 0 at the top of the tibia, 1 at its bottom.
struct SeenArtery {
    bool is_seen = false;
    double from = 0.0, to = 0.0;   ///< levels between which it is seen
    bool reaches_foot = false;     ///< seen below level 0.85; the peroneal below 0.75, where it normally divides
    bool has_lost_stretch = false;
};

struct RunOff {
    std::array<SeenArtery, 3> arteries;  ///< in the order of LegArtery
    double from = 1.0, to = 0.0;         ///< levels that the track covers
    bool is_judged = false;              ///< the track covers levels 0.4 to 0.7
    std::vector<std::string> warnings;   ///< sentences for whoever plans
};

/// Names vessels by their place beside the bones, in cross-sections between level 0.3 and the ankle. Assumes that the leg
/// is not malformed, that the axes are right within about 5 mm, and this anatomy: the anterior tibial artery lies in
/// front of the plane through both bones; of those behind it, the peroneal artery lies closer to the fibula and the
/// posterior tibial artery closer to the tibia. What was not tracked counts as not seen: it may be open. No clinical
/// advice. Throws Error when the axes are shorter than 100 mm, closer than 10 mm, or when the fibula is not lateral on
/// the stated side.
RunOff run_off(const Track& track, const LegGeometry& leg);

}  // namespace tactus::vessel
