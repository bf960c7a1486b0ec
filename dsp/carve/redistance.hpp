// SPDX-License-Identifier: Apache-2.0
// Re-distancing: restores the distance property of a distorted field, a few bricks at a time.
#pragma once

#include "dsp/volume/bricks.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::carve {

/// Fast sweeping (Zhao 2005) over single bricks, taken from a first-in first-out queue.
///
/// Samples next to the surface get |d|/|∇d| with the upwind gradient, which keeps the surface in place; from there the
/// Eikonal equation |∇d| = 1 is solved inside the brick, with the samples around it as boundary values. Signs never
/// change. A brick whose gradients all lie within 5 % of 1 is skipped; one that changes adds its neighbours to the
/// queue. The carver's own fields do not need this.
class Redistance {
public:
    /// `reach`: m from the surface up to which the field matters.
    void prepare(const volume::BoneEditor& bone, double reach);

    /// Appends bricks to the queue, except those already in it. Wait-free.
    void add(std::span<const std::uint32_t> bricks) noexcept;

    /// Processes at most `bricks` of the queue; returns how many remain. Stops early when the editor's budget of
    /// changes is exhausted. About 0.1 ms per brick.
    std::size_t tick(volume::BoneEditor& bone, int bricks) noexcept;

    std::size_t waiting() const noexcept { return count_; }

private:
    void push(std::uint32_t brick) noexcept;

    std::vector<std::uint32_t> queue_;  // ring
    std::vector<std::uint8_t> queued_;  // per brick
    std::size_t head_ = 0, count_ = 0;
    double reach_ = 0.0;
};

}  // namespace tactus::carve
