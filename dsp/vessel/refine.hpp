// SPDX-License-Identifier: Apache-2.0
// Centre and radius of every node of a track, with a short window and the profile of a blurred disc.
#pragma once

#include "dsp/vessel/search.hpp"

#include <optional>

namespace tactus::vessel {

struct Refined {
    std::vector<Node> nodes;  ///< empty when nothing is left
    /// Where the radius of the refined nodes doubles within a few of them, as the search does not let it: the track has left
    /// its vessel, and is cut there. None: it is not cut for that.
    std::optional<End> start, end;
};

/// A branch through the tubes: nodes about a sample apart, refined; its ends are cut where the contrast in the
/// short window is no longer that of the vessel. No radius is above that of the search's settings. `inside`: a place that is
/// kept. `cut_start`, `cut_end`: which ends.
Refined refined_nodes(const Search& search, const std::vector<Tube>& tubes, double reference_contrast,
                      const Vec3& inside, bool cut_start, bool cut_end);

}  // namespace tactus::vessel
