// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/surface_density.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace tactus::volume {

void extend_density(const Grid& distance, Grid& density) {
    constexpr int layers = 2;
    const double reach = (layers + 0.75) * std::max({distance.spacing.x, distance.spacing.y, distance.spacing.z});
    const std::array<int, 3>& size = distance.size;
    std::vector<std::uint8_t> known(distance.count());
    std::vector<std::array<int, 3>> open;
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i) {
                const std::size_t n = distance.index(i, j, k);
                known[n] = distance.values[n] < 0.0f;
                if (!known[n] && static_cast<double>(distance.values[n]) < reach) open.push_back({i, j, k});
            }
    for (int layer = 0; layer < layers; ++layer) {
        std::vector<std::array<int, 3>> later;
        std::vector<std::pair<std::size_t, float>> found;
        for (const auto& [i, j, k] : open) {
            double sum = 0.0;
            int count = 0;
            for (int z = std::max(k - 1, 0); z <= std::min(k + 1, size[2] - 1); ++z)
                for (int y = std::max(j - 1, 0); y <= std::min(j + 1, size[1] - 1); ++y)
                    for (int x = std::max(i - 1, 0); x <= std::min(i + 1, size[0] - 1); ++x)
                        if (const std::size_t m = distance.index(x, y, z); known[m]) {
                            sum += static_cast<double>(density.values[m]);
                            ++count;
                        }
            if (count > 0) found.emplace_back(distance.index(i, j, k), static_cast<float>(sum / count));
            else later.push_back({i, j, k});
        }
        for (const auto& [n, value] : found) {
            density.values[n] = value;
            known[n] = 1;
        }
        open = std::move(later);
    }
}

}  // namespace tactus::volume
