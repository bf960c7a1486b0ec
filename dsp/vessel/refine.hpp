// SPDX-License-Identifier: Apache-2.0
// Centre and radius of every node of a track, with a short window and the profile of a blurred disc.
#pragma once

#include "dsp/vessel/search.hpp"

namespace tactus::vessel {

/// A branch through the tubes: nodes about a sample apart, refined; its ends are cut where the contrast in the
/// short window is no longer that of the vessel. `inside`: a place that is kept. `cut_start`, `cut_end`: which ends. Empty when nothing is left.
std::vector<Node> refined_nodes(const Search& search, const std::vector<Tube>& tubes, double reference_contrast,
                                const Vec3& inside, bool cut_start, bool cut_end);

}  // namespace tactus::vessel
