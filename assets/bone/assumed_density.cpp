// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/assumed_density.hpp"

#include "dsp/core/stop.hpp"

#include <algorithm>

namespace tactus::bone {

namespace {

constexpr double cortex = 1800.0, core = 400.0;             // kg/m³
constexpr double cortex_depth = 2e-3, core_depth = 3e-3;    // m

float density_at(double depth) {
    if (depth < 0.0) return 0.0f;
    const double t = std::clamp((depth - cortex_depth) / (core_depth - cortex_depth), 0.0, 1.0);
    return static_cast<float>(cortex - (cortex - core) * t * t * (3.0 - 2.0 * t));
}

}  // namespace

volume::Grid assumed_density(const volume::Grid& distance) {
    volume::Grid density{distance.size, distance.origin, distance.spacing, {}};
    density.values.reserve(distance.count());
    for (const float d : distance.values) {
        if (density.values.size() % (1 << 20) == 0) leave_if_stopped();
        density.values.push_back(density_at(-double(d)));
    }
    return density;
}

std::string assumed_density_law() { return "assumed: 1800 kg/m3 to 2 mm depth, falling to 400 at 3 mm"; }

}  // namespace tactus::bone
