// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/noise.hpp"

#include <algorithm>
#include <numbers>

namespace tactus::vessel {

namespace {

constexpr int half_box = 24;

// Standard deviation of the difference of two samples `lag` apart, from the median of its size.
double spread(const Scan& scan, const std::array<int, 3>& centre, std::size_t axis, int lag, double low, double high) {
    const volume::Grid& grid = scan.grid();
    std::array<int, 3> first, last;
    for (std::size_t a = 0; a < 3; ++a) {
        first[a] = std::max(0, centre[a] - half_box);
        last[a] = std::min(grid.size[a] - 1, centre[a] + half_box) - (a == axis ? lag : 0);
    }
    std::vector<float> sizes;
    for (int k = first[2]; k <= last[2]; ++k)
        for (int j = first[1]; j <= last[1]; ++j)
            for (int i = first[0]; i <= last[0]; ++i) {
                const float a = grid.at(i, j, k);
                const float b = grid.at(i + (axis == 0) * lag, j + (axis == 1) * lag, k + (axis == 2) * lag);
                if (double(std::min(a, b)) >= low && double(std::max(a, b)) <= high) sizes.push_back(std::abs(a - b));
            }
    if (sizes.size() < 200) return 0.0;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return double(*middle) / 0.6745;
}

}  // namespace

Noise measured_noise(const Scan& scan, const Vec3& centre, double low, double high) {
    const Vec3 at = scan.index_of(centre);
    const std::array<int, 3> middle{static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)};
    Noise noise;
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double near = spread(scan, middle, axis, 1, low, high), far = spread(scan, middle, axis, 4, low, high);
        sum += 0.5 * far * far;
        if (!(far > 0.0)) continue;
        // White noise under a normal filter of s samples: correlation exp(-1 / 4s²) of neighbours, 2 √π s samples in one.
        const double neighbours = std::clamp(1.0 - near * near / (far * far), 0.0, 0.85);
        if (neighbours > 0.02) {
            const double s = 0.5 / std::sqrt(-std::log(neighbours));
            noise.correlation[static_cast<int>(axis)] = std::max(1.0, 2.0 * std::sqrt(std::numbers::pi) * s);
        }
    }
    noise.sigma = std::sqrt(sum / 3.0);
    return noise;
}

}  // namespace tactus::vessel
