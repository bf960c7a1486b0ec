// SPDX-License-Identifier: Apache-2.0
// Warnings for a person who plans with a tracked vessel.
#pragma once

#include "dsp/vessel/track.hpp"

#include <string>
#include <vector>

namespace tactus::vessel {

struct TrackWarning {
    std::size_t branch = 0, node = 0;  ///< the position; `node` of `branch`
    std::string text;  ///< a sentence that names the branch; mm
};

/// Returns, branch by branch: narrowings of 50 % and more; lost stretches; and ends where the contrast is lost or the
/// vessel is indistinguishable from noise although it is wide enough to be visible further on, which a narrowing of 85
/// % over four radii also causes. Ends of side branches shorter than six radii are not reported.
std::vector<TrackWarning> warnings_of(const Track& track);

/// Returns text such as "narrowed by 70 ± 5 % against 4.00 mm at 1.0, 2.0, 3.0", with ", uncertain" if it is; LPS, mm.
std::string text_of(const Branch& branch, const Stenosis& stenosis);

}  // namespace tactus::vessel
