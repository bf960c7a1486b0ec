// SPDX-License-Identifier: Apache-2.0
// The shape of a rope, for other nodes and displays.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tactus::rope {

/// The points of a rope in a scene, and the fraction of the strain limit at each segment. Passed by value.
struct RopeShape {
    static constexpr std::string_view wire_name = "rope";
    static constexpr std::size_t max_points = 65;

    std::array<std::array<float, 3>, max_points> points{};  ///< m
    std::array<float, max_points> load{};  ///< of the segment after a point: 0 slack, 1 at the limit or beyond
    std::uint32_t count = 0;  ///< number of points; 0: no rope
    float radius = 0.0f;  ///< m
    std::uint32_t is_vein = 0;
    std::int64_t version = 0;
    std::uint64_t content_hash = 0;
};

}  // namespace tactus::rope
