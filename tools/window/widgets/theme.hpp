// SPDX-License-Identifier: Apache-2.0
// Colours and sizes of the window.
#pragma once

#include "graph/node/value.hpp"

#include <cstdint>
#include <string_view>

namespace tactus::window {

/// Packed as in Dear ImGui: alpha, blue, green, red.
constexpr std::uint32_t colour(std::uint32_t rgb, std::uint32_t alpha = 255) {
    return alpha << 24 | (rgb & 0xFF) << 16 | (rgb & 0xFF00) | rgb >> 16;
}
constexpr std::uint32_t faded(std::uint32_t packed, double share) {
    return (packed & 0xFFFFFF) | static_cast<std::uint32_t>(static_cast<double>(packed >> 24) * share) << 24;
}

namespace tone {
inline constexpr std::uint32_t ground = colour(0x12161d), lane = colour(0x1a202a), lane_edge = colour(0x2a3342),
                               node = colour(0x262f3d), node_head = colour(0x313c4d), node_edge = colour(0x46546a),
                               chosen = colour(0xf2b84b), text = colour(0xe8edf4), dim = colour(0x93a1b5),
                               grid = colour(0x2a3342), bad = colour(0xff5c5c), good = colour(0x46d39a),
                               warm = colour(0xf2b84b), cursor = colour(0x5ab0ff);
/// Told apart by people who confuse red and green, too.
inline constexpr std::uint32_t curves[] = {colour(0x2fa7ff), colour(0xe28643), colour(0xb0ffa1), colour(0xc2599f),
                                           colour(0xfedd46), colour(0xf16f85), colour(0xc5ffe3), colour(0xbed9ff)};
}  // namespace tone

/// Colour of a wire by its type; null: any type. Told apart by people who confuse red and green, too.
std::uint32_t colour_of(const ValueType* type);

/// Colour of a node or comment by its name in the patch; grey for unknown names.
std::uint32_t colour_named(std::string_view name);

/// Sets colours and sizes of all widgets; `scale`: relative to a standard screen.
void apply_theme(double scale);

}  // namespace tactus::window
