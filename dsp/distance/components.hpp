// SPDX-License-Identifier: Apache-2.0
// Connected parts of what lies at or above a value, and the hollows they enclose.
#pragma once

#include "dsp/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus {

/// Neighbouring samples of one row that belong together.
struct SampleRun {
    int begin, end;      ///< along x; end is behind the last
    int j, k;            ///< the row
    std::int32_t part;   ///< rank of its component, 0 is the largest
};

/// Parts of {grey ≥ iso}, joined through faces, edges and corners (26 neighbours), largest first; equal sizes in the
/// order of their first sample.
struct Components {
    std::vector<SampleRun> runs;      ///< in the order of samples
    std::vector<std::size_t> voxels;  ///< samples of each, descending
    struct Box {
        std::array<int, 3> first, last;
    };
    std::vector<Box> boxes;  ///< samples at the ends of each, inclusive
};
Components components_above(const Grid& grey, float iso);

/// Takes all components but the `keep` largest out of `grey` by mirroring their samples about iso. Samples below iso
/// stay as they are, so the surface of what is kept does not move.
void keep_largest(Grid& grey, float iso, const Components& components, std::size_t keep);

/// Makes solid every hollow (samples < iso, joined through faces) that does not reach the border, by mirroring about
/// iso. The outer surface does not move. Returns the number of samples changed.
std::size_t fill_hollows(Grid& grey, float iso);

}  // namespace tactus
