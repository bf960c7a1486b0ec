// SPDX-License-Identifier: Apache-2.0
// What a picture of a large bone costs, with every triangle and with what a picture of something that moves has.
#pragma once

#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::bench {

struct PictureCost {
    std::string what;  ///< "all of it, moving"
    double ms = 0.0;   ///< by the clock on the wall, the best of some
    std::size_t triangles = 0;  ///< drawn
};

struct PictureCosts {
    std::size_t triangles = 0;  ///< of the bone
    int width = 0, height = 0;
    std::vector<PictureCost> pictures;
};

/// Four samples per pixel. Throws Error when no OpenGL context can be had.
PictureCosts picture_costs(const volume::Grid& distance, const volume::Grid& density, int rounds);

}  // namespace tactus::bench
