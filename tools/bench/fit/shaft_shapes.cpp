// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/fit/shaft_shapes.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::bench {

namespace {

constexpr double shape_voxel = 0.3 * mm;

struct ShaftShape {
    double radius, half_length, three, three_at, two, two_at, crest, crest_at, crest_width, twist, bow, wall;

    explicit ShaftShape(int number) {
        const Random random{40'000 + static_cast<std::uint64_t>(number)};
        std::uint64_t drawn = 0;
        const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(drawn++); };
        radius = between(4.8, 8.5) * mm;
        half_length = between(25.0, 35.0) * mm;
        three = between(0.03, 0.12), three_at = between(0.0, 2.0 * std::numbers::pi);
        two = between(0.02, 0.12), two_at = between(0.0, 2.0 * std::numbers::pi);
        crest = between(0.0, 0.2), crest_at = between(0.0, 2.0 * std::numbers::pi), crest_width = between(0.3, 0.6);
        twist = between(-8.0, 8.0);
        bow = between(0.3, 1.0);
        wall = std::min(between(2.0, 4.0) * mm, 0.6 * radius);
    }

    double outline(double angle, double z) const {
        const double turned = angle - twist * z;
        const double from_crest = std::remainder(turned - crest_at, 2.0 * std::numbers::pi) / crest_width;
        return radius * (1.0 + three * std::cos(3.0 * (turned - three_at)) + two * std::cos(2.0 * (turned - two_at)) +
                         crest * std::exp(-from_crest * from_crest));
    }

    double distance(const Vec3& p) const {
        const double x = p.x + p.z * p.z / (2.0 * bow), r = std::hypot(x, p.y), angle = std::atan2(p.y, x);
        constexpr double step = 1e-4;
        const double edge = outline(angle, p.z);
        const double slope = (outline(angle + step, p.z) - outline(angle - step, p.z)) / (2.0 * step);
        const double side = (r - edge) / std::sqrt(1.0 + slope * slope / (edge * edge));
        return std::max({side, -(side + wall), std::abs(p.z) - half_length});
    }
};

}  // namespace

bone::Bone shaft_shape(int number) {
    constexpr float cortical = 1800.0f;  // kg/m³
    const ShaftShape shape(number);
    const double across = 1.45 * shape.radius + 3.0 * mm;
    volume::Grid grid;
    grid.spacing = Vec3(shape_voxel);
    grid.origin = -Vec3(across, across, shape.half_length + 2.0 * mm);
    for (int axis = 0; axis < 3; ++axis)
        grid.size[static_cast<std::size_t>(axis)] = static_cast<int>(-2.0 * grid.origin[axis] / shape_voxel) + 1;
    bone::Bone bone;
    bone.name = "shaft";
    bone.distance = bone.density = grid;
    bone.distance.values.reserve(grid.count());
    bone.density.values.reserve(grid.count());
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const double d = shape.distance(grid.position(i, j, k));
                bone.distance.values.push_back(static_cast<float>(d));
                bone.density.values.push_back(d < 0.0 ? cortical : 0.0f);
            }
    return bone;
}

}  // namespace tactus::bench
