// SPDX-License-Identifier: Apache-2.0
// Centre and radius of every node of a track, with a short window and the profile of a blurred disc.
#pragma once

#include "dsp/vessel/search.hpp"

#include <optional>

namespace tactus::vessel {

struct Refined {
    std::vector<Node> nodes;  ///< empty if none remains
    /// Reason of a cut where the radius of the refined nodes doubles within a few nodes, which the search does not
    /// permit: the track has left its vessel. Empty if there is no such cut.
    std::optional<End> start, end;
};

/// Returns a branch through the tubes: refined nodes about a sample apart. Its ends are cut where the contrast in the
/// short window is no longer that of the vessel. Radii are limited as in the search's settings. `inside`: a position
/// that is kept. `cut_start`, `cut_end`: the ends to cut.
Refined refined_nodes(const Search& search, const std::vector<Tube>& tubes, double reference_contrast,
                      const Vec3& inside, bool cut_start, bool cut_end);

}  // namespace tactus::vessel
