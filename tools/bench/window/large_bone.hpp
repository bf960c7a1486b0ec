// SPDX-License-Identifier: Apache-2.0
// Cost of drawing a large bone, with all triangles and with the level of detail for moving scenes.
#pragma once

#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::bench {

struct PictureCost {
    std::string what;  ///< "all of it, moving"
    double ms = 0.0;   ///< wall-clock time, best of several
    std::size_t triangles = 0;  ///< drawn
};

struct PictureCosts {
    std::size_t triangles = 0;  ///< of the bone
    int width = 0, height = 0;
    std::vector<PictureCost> pictures;
};

/// Four samples per pixel. Throws Error when there is no OpenGL context.
PictureCosts picture_costs(const volume::Grid& distance, const volume::Grid& density, int rounds);

}  // namespace tactus::bench
