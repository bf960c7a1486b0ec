// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/bone/saw_spacing.hpp"

#include "dsp/carve/kerf_voxels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::analysis {

double narrowest_kerf_mm(const std::array<double, 3>& voxel_mm) {
    return carve::voxels_per_kerf * *std::max_element(voxel_mm.begin(), voxel_mm.end());
}

double coarsest_spacing_mm(double kerf_mm) { return carve::coarsest_voxel(kerf_mm * 1e-3) * 1e3; }

std::string saw_line(const std::array<double, 3>& voxel_mm) {
    const double narrowest = narrowest_kerf_mm(voxel_mm);
    if (narrowest <= usual_kerf_mm) return fmt::format("a saw can cut it with a kerf of {:.2g} mm or wider", narrowest);
    return fmt::format(
        "coarse for a saw of {:g} mm kerf, which needs --spacing {:g} or finer: a patch resamples it around the site; "
        "as "
        "it is, the kerf must be {:.2g} mm or wider",
        usual_kerf_mm, coarsest_spacing_mm(usual_kerf_mm), std::ceil(10.0 * narrowest) / 10.0);
}

}  // namespace tactus::analysis
