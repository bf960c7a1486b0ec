// SPDX-License-Identifier: Apache-2.0
// The surface of a scan's bone, coloured by labels. No user interface.
#pragma once

#include "dsp/display/camera.hpp"
#include "dsp/geometry/brick_surface.hpp"
#include "tools/window/slices/live_labels.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tactus::window {

struct BoneMesh {
    geometry::SurfacePatch patch;     ///< m, LPS
    std::vector<std::int32_t> node;   ///< of each vertex; -1: none is near
    display::Bounds bounds;
};
/// The surface net of the bone, smoothed. Of every second sample when the scan's box has more than 12 million.
BoneMesh bone_mesh(const analysis::ScanGraph& scan, const RunJobs& run = run_in_turn);

/// Colours the vertices: by label, darker where a seed lies, bone where there is none.
void colour_mesh(BoneMesh& mesh, const LiveLabelling* labels, const std::vector<std::array<std::uint8_t, 3>>& colours);

}  // namespace tactus::window
