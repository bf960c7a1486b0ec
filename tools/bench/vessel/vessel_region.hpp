// SPDX-License-Identifier: Apache-2.0
// Which voxels belong to a vessel, by a rule that knows nothing of the tracker.
#pragma once

#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <vector>

namespace tactus::bench {

/// Voxels of a grid, 1 inside.
using Mask = std::vector<char>;

/// Slice by slice across `axis`, from the one of the seed both ways: the samples between `low` and `high` that are joined
/// within the slice and lie beside some of the slice before. Ends where nothing is left, or where the area is more than
/// twice the median of the slices before: there the vessel leaves another one.
Mask grown_region(const volume::Grid& grid, const Vec3& seed, double low, double high, std::size_t axis);

/// The mask grown by one sample (26 neighbours).
Mask grown(const volume::Grid& grid, const Mask& mask);

/// Value of the mask at the nearest sample; false outside of the grid.
bool holds(const volume::Grid& grid, const Mask& mask, const Vec3& place);

/// Three projections of the brightest samples (-150 to 700) around the region: the region green, the places red.
void draw_region(const volume::Grid& grid, const Mask& region, const std::vector<Vec3>& places,
                 const std::filesystem::path& path);

}  // namespace tactus::bench
