// SPDX-License-Identifier: Apache-2.0
// What whoever plans with a tracked vessel must know.
#pragma once

#include "dsp/vessel/track.hpp"

#include <string>
#include <vector>

namespace tactus::vessel {

struct TrackWarning {
    std::size_t branch = 0, node = 0;  ///< the place; `node` of `branch`
    std::string text;  ///< a sentence that names the branch; mm
};

/// Branch by branch: narrowings of 50 % and more, lost stretches, and ends where the contrast is lost or the vessel is not told
/// from noise, of vessels that are wide enough to be seen further: a narrowing of 85 % over four radii looks like that. None
/// of those for side branches shorter than six radii.
std::vector<TrackWarning> warnings_of(const Track& track);

/// "narrowed by 70 ± 5 % against 4.00 mm at 1.0, 2.0, 3.0", with ", uncertain" where it is; LPS, mm.
std::string text_of(const Branch& branch, const Stenosis& stenosis);

}  // namespace tactus::vessel
