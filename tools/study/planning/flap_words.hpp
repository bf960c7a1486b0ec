// SPDX-License-Identifier: Apache-2.0
// Texts about a flap, common to its report and its listing.
#pragma once

#include "dsp/reconstruct/ranking.hpp"
#include "dsp/reconstruct/reach.hpp"

#include <string>

namespace tactus::study {

/// "artery 'peroneal' to 'facial artery': slack; 120.0 mm in the leg, …"
std::string reach_words(const reconstruct::SiteReach& reach);

/// "left leg, pedicle at the last plane, turned by 180°: as given"
std::string candidate_words(const reconstruct::Candidate& candidate);

}  // namespace tactus::study
