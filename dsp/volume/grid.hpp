// SPDX-License-Identifier: Apache-2.0
// A dense, axis-aligned grid of samples: the exchange format between import, files and the brick volume.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace tactus::volume {

/// Samples at origin + (i·spacing.x, j·spacing.y, k·spacing.z), x fastest. Frame: LPS, metres.
struct Grid {
    std::array<int, 3> size{0, 0, 0};
    Vec3 origin{0.0, 0.0, 0.0};   ///< centre of sample (0, 0, 0), m
    Vec3 spacing{0.0, 0.0, 0.0};  ///< m, each > 0
    std::vector<float> values;    ///< size[0]·size[1]·size[2]

    std::size_t index(int i, int j, int k) const {
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(size[0]) +
               static_cast<std::size_t>(i);
    }
    float at(int i, int j, int k) const { return values[index(i, j, k)]; }
    float& at(int i, int j, int k) { return values[index(i, j, k)]; }
    Vec3 position(int i, int j, int k) const { return origin + Vec3(i, j, k) * spacing; }
    std::size_t count() const {
        return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
               static_cast<std::size_t>(size[2]);
    }
};

}  // namespace tactus::volume
