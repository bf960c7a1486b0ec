// SPDX-License-Identifier: Apache-2.0
// Texts about a flap, common to its report and its listing.
#pragma once

#include "dsp/reconstruction/ranking.hpp"
#include "dsp/reconstruction/reach.hpp"

#include <string>

namespace tactus::analysis {

/// "artery 'peroneal' to 'facial artery': slack; 120.0 mm in the leg, …"
std::string reach_words(const reconstruction::SiteReach& reach);

/// "left leg, pedicle at the last plane, turned by 180°: as given"
std::string candidate_words(const reconstruction::Candidate& candidate);

}  // namespace tactus::analysis
