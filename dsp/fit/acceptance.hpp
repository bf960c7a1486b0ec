// SPDX-License-Identifier: Apache-2.0
// What a fit of two painted faces must show before anything believes it. The live search, the verbs of plans and the
// assembly of a case take their thresholds from here, and from nowhere else.
#pragma once

namespace tactus::fit {

struct Acceptance {
    static constexpr double least_score = 0.20;
    static constexpr double least_margin = 0.10;  ///< to the second best pose, as share of the best score
    static constexpr double least_share = 0.10;  ///< of the smaller face of the two
    static constexpr double least_area = 0.0;  ///< m² on each other; coarse scans need more, see widen_for
};

}  // namespace tactus::fit
