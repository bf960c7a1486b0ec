// SPDX-License-Identifier: Apache-2.0
// Makes a distorted field a distance again, a few bricks at a time.
#pragma once

#include "dsp/volume/bricks.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::carve {

/// Fast sweeping (Zhao 2005) over single bricks, taken from a queue in the order they were put in.
///
/// Samples beside the surface get |d|/|∇d| with the upwind gradient, which leaves the surface where it is; from there the
/// Eikonal equation |∇d| = 1 is solved inside the brick, against the samples around it. Signs never change. A brick whose
/// gradients all lie within 5 % of 1 is not touched; one that changes puts its neighbours into the queue. The carver
/// leaves a field that needs none of this: it is for fields made by other means.
class Redistance {
public:
    /// `reach`: m from the surface up to which the field matters.
    void prepare(const volume::BoneEditor& bone, double reach);

    /// Puts bricks at the end of the queue; those that wait already are left where they are. Wait-free.
    void add(std::span<const std::uint32_t> bricks) noexcept;

    /// Works on at most `bricks` of the queue; returns how many still wait. Stops early where the editor has no room for
    /// more changes. About 0.1 ms per brick.
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
