// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/break_bone.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/volume/iso_distance.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::plan {

namespace {

constexpr double room = 5e-3;

/// Grid around the moved solid.
volume::Grid layout_of(const volume::Grid& solid, const Pose& placement, const Vec3& voxel) {
    Vec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (int k = 0; k < solid.size[2]; ++k)
        for (int j = 0; j < solid.size[1]; ++j)
            for (int i = 0; i < solid.size[0]; ++i) {
                if (!(solid.at(i, j, k) < 0.0f)) continue;
                const Vec3 p = placement.apply(solid.position(i, j, k));
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
    if (!(low.x <= high.x)) throw Error("there is nothing to scan: the solid is empty");
    volume::Grid layout;
    layout.origin = low - Vec3(room);
    layout.spacing = voxel;
    for (int axis = 0; axis < 3; ++axis)
        layout.size[static_cast<std::size_t>(axis)] =
            static_cast<int>(std::ceil((high[axis] + room - layout.origin[axis]) / voxel[axis])) + 1;
    return layout;
}

/// Gaussian filter along one axis; the border value is repeated.
void blur_along(volume::Grid& grid, int axis, double sigma_samples) {
    const int reach = static_cast<int>(std::ceil(3.0 * sigma_samples));
    if (!(sigma_samples > 0.05)) return;
    std::vector<float> weight;
    float total = 0.0f;
    for (int n = -reach; n <= reach; ++n) {
        weight.push_back(static_cast<float>(std::exp(-0.5 * n * n / (sigma_samples * sigma_samples))));
        total += weight.back();
    }
    const int length = grid.size[static_cast<std::size_t>(axis)];
    std::vector<float> line(static_cast<std::size_t>(length));
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    std::array<int, 3> at{};
    for (at[static_cast<std::size_t>(a)] = 0; at[static_cast<std::size_t>(a)] < grid.size[static_cast<std::size_t>(a)];
         ++at[static_cast<std::size_t>(a)])
        for (at[static_cast<std::size_t>(b)] = 0;
             at[static_cast<std::size_t>(b)] < grid.size[static_cast<std::size_t>(b)];
             ++at[static_cast<std::size_t>(b)]) {
            const auto sample = [&](int n) -> float& {
                at[static_cast<std::size_t>(axis)] = n;
                return grid.at(at[0], at[1], at[2]);
            };
            for (int n = 0; n < length; ++n) line[static_cast<std::size_t>(n)] = sample(n);
            for (int n = 0; n < length; ++n) {
                float sum = 0.0f;
                for (int m = -reach; m <= reach; ++m)
                    sum += weight[static_cast<std::size_t>(m + reach)] *
                           line[static_cast<std::size_t>(std::clamp(n + m, 0, length - 1))];
                sample(n) = sum / total;
            }
        }
}

}  // namespace

volume::Grid scan_solid(const volume::Grid& solid, const Pose& placement, const ScanOptions& options) {
    const contact::Voxmap map = contact::make_voxmap(solid);
    const Pose back = placement.inverse();
    const Mat3 turn = glm::mat3_cast(back.orientation);
    volume::Grid grey = layout_of(solid, placement, options.voxel);
    const double edge = (options.voxel.x + options.voxel.y + options.voxel.z) / 3.0;
    grey.values.reserve(grey.count());
    for (int k = 0; k < grey.size[2]; ++k)
        for (int j = 0; j < grey.size[1]; ++j)
            for (int i = 0; i < grey.size[0]; ++i) {
                const volume::Sample here = map.sample(back.position + turn * grey.position(i, j, k));
                // Partial volume: the share of the voxel that is bone.
                const double share = here.inside ? std::clamp(0.5 - here.value / edge, 0.0, 1.0) : 0.0;
                grey.values.push_back(static_cast<float>(share));
            }
    for (int axis = 0; axis < 3; ++axis) blur_along(grey, axis, options.blur / options.voxel[axis]);
    const Random random{options.seed};
    for (std::size_t n = 0; n < grey.values.size(); ++n)
        grey.values[n] += static_cast<float>(options.noise * random.normal(n));
    return volume::distance_to_iso(volume::smoothed(grey), 0.5f);
}

}  // namespace tactus::plan
