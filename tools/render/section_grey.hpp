// SPDX-License-Identifier: Apache-2.0
// Density on the sections of a scene: read from files, and as shades of grey.
#pragma once

#include "devices/display/legend.hpp"
#include "devices/display/scan_pool.hpp"
#include "dsp/volume/bricks.hpp"
#include "dsp/volume/grid.hpp"

#include <filesystem>
#include <vector>

namespace tactus::render {

/// kg/m³: from no bone at all to the densest cortex.
inline constexpr display::GreyScale section_grey{0.0, 2000.0};
display::Legend::Scale section_scale();

/// kg/m³ at all samples of a bone; where nothing is stored, 0. Copied layer by layer.
struct DensityCopy {
    volume::Grid grid;
    int layers = 0;  ///< of bricks, copied

    /// Copies the next layer of bricks. True: it was the last one.
    bool add_layer(const volume::BoneSnapshot& bone);
};

/// kg/m³: of the bone of a file, or of each fragment of a plan, in its order; one that is not a bone's file has an empty
/// grid. Empty when the file cannot be read.
std::vector<volume::Grid> read_densities(const std::filesystem::path& file);

}  // namespace tactus::render
