// SPDX-License-Identifier: Apache-2.0
// The cutting front of a tool at one tick, as a value on wires.
#pragma once

#include "dsp/core/hash.hpp"
#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tactus::carve {

/// Progress of a cut: the centres of the tool's round front, half a kerf behind the floor of the cut, in a row along
/// the edge. For the ball of a burr, all nodes are equal (two). Consecutive fronts form the path that `Carver` removes.
struct CutFront {
    static constexpr std::string_view wire_name = "front";
    static constexpr std::size_t max_nodes = 64;

    Pose pose;  ///< of the tool: x along the edge, y the cutting direction, z across
    double kerf = 0.0;  ///< m, width of the cut
    double pitch = 0.0;  ///< m between nodes
    std::uint64_t seated = 0;  ///< bit per node: it follows the tool; other nodes lie in uncut bone
    std::uint64_t fresh = 0;  ///< bit per node: newly placed, no path leads here
    std::array<std::array<float, 3>, max_nodes> offset{};  ///< m from pose.position, axes of the scene
    std::int32_t count = 0;
    std::int32_t running = 0;  ///< 1: the tool is powered and cuts
    std::int64_t version = 0;  ///< counts ticks
    std::uint64_t content_hash = 0;

    Vec3 at(std::size_t n) const noexcept {
        return pose.position + Vec3(static_cast<double>(offset[n][0]), static_cast<double>(offset[n][1]),
                                    static_cast<double>(offset[n][2]));
    }
    void place(std::size_t n, const Vec3& at) noexcept {
        const Vec3 d = at - pose.position;
        offset[n] = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
    }
    bool is_seated(std::size_t n) const noexcept { return seated >> n & 1u; }
    bool is_fresh(std::size_t n) const noexcept { return fresh >> n & 1u; }
};

inline std::uint64_t hash_of(const CutFront& front) noexcept {
    Hash hash;
    hash.add_bytes(&front.pose, sizeof(Pose));
    hash.add_word(front.seated);
    hash.add_word(front.fresh ^ static_cast<std::uint64_t>(front.running) << 63);
    hash.add_bytes(front.offset.data(), static_cast<std::size_t>(front.count) * sizeof(front.offset[0]));
    return hash.state;
}

}  // namespace tactus::carve
