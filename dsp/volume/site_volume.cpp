// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"
#include "dsp/volume/resample.hpp"
#include "dsp/volume/site.hpp"
#include "dsp/volume/site_geometry.hpp"
#include "dsp/volume/surface_density.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::volume {

SiteVolume refine_at(const SawSite& site, const Grid& distance, const Grid& density, double spacing,
                     const SiteRequest& request) {
    const Vec3 across = glm::cross(site.stroke, site.feed);
    const double along = 0.5 * request.blade_length + request.travel, beside = 10e-3;
    const double above = request.blade_height + 5e-3, below = std::min(site.thickness + 8e-3, deepest_site);
    Vec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p = site.point + site.stroke * (corner & 1 ? along : -along) +
                       site.feed * (corner & 2 ? below : -above) + across * (corner & 4 ? beside : -beside);
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const Vec3 last = distance.position(distance.size[0] - 1, distance.size[1] - 1, distance.size[2] - 1);
    low = glm::max(low, distance.origin);
    high = glm::min(high, last);
    SiteVolume made;
    Grid& grid = made.distance;
    grid.spacing = Vec3(spacing);
    grid.origin = low;
    double samples = 1.0;
    for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        grid.size[a] = std::max(2, static_cast<int>((high[axis] - low[axis]) / spacing) + 1);
        samples *= grid.size[a];
    }
    if (samples > 40e6)
        throw Error(
            fmt::format("around the site {:.3g} million samples of {:.3g} mm would be needed; widen the kerf or "
                        "import the bone with --crop and --spacing",
                        samples * 1e-6, spacing * 1e3));
    const Grid layout = grid;
    made.distance = resampled(distance, layout);
    Grid to_surface = density;
    extend_density(distance, to_surface);
    made.density = resampled(std::move(to_surface), layout);
    for (float& value : made.density.values) value = std::max(value, 0.0f);
    return made;
}

}  // namespace tactus::volume
