// SPDX-License-Identifier: Apache-2.0
// One scan as files of several types: `segment` must give them the same labels.
#pragma once

#include "assets/file/json.hpp"
#include "tools/bench/segmentation/seeded_case.hpp"

namespace tactus::bench {

/// Share of the bone voxels whose label differs: of the same whole numbers as uint16 and as float beside int16, of HU / 1000
/// and of an 8-bit window (-200 to 1800 HU) beside HU. Each goes the way of a user's file, with the
/// threshold that is chosen for it; for eight bits both get one
/// that divides the same voxels, as a window tells no HU.
file::Json format_row(const SeededCase& real, int dabs);

}  // namespace tactus::bench
