// SPDX-License-Identifier: Apache-2.0
// A straightened vessel: cross-sections along its centre line, side by side.
#pragma once

#include "dsp/vessel/track.hpp"

#include <vector>

namespace tactus::vessel {

/// Two longitudinal cuts through the centre line, at right angles. Columns are along the vessel, rows across it.
struct Straightened {
    int columns = 0, rows = 0;   ///< of each cut
    double spacing = 0.0;        ///< m, of columns and rows
    std::vector<float> first, second;  ///< columns × rows values of the scan, row by row
    std::vector<double> radius;  ///< m, per column
    std::vector<char> is_lost;   ///< per column
};

/// The frame is transported without twist (Bishop). `half_width` in m across the vessel; positions outside of the scan
/// get the value at its border. Throws Error for a branch of fewer than two nodes.
Straightened straightened(const volume::Grid& grid, const Branch& branch, double half_width);

}  // namespace tactus::vessel
