// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/outer_shell.hpp"

#include "dsp/volume/components.hpp"
#include "dsp/volume/iso_distance.hpp"

namespace tactus::volume {

Grid outer_shell(const Grid& distance, double radius, const RunJobs& run) {
    Grid depth = distance;
    for (float& v : depth.values) v = -v;
    // Far from the surface the input need not be a distance; the re-computed field is one.
    depth = distance_to_iso(depth, 0.0f, run);
    for (float& v : depth.values) v = -v;
    const auto grown = static_cast<float>(-radius);
    fill_hollows(depth, grown);
    Grid shell = distance_to_iso(depth, grown, run);
    for (float& v : shell.values) v -= grown;
    return shell;
}

}  // namespace tactus::volume
