// SPDX-License-Identifier: Apache-2.0
// The constraint planes of a proxy and the point in all their half-spaces that is nearest to the hand: the god-object
// method (Zilles and Salisbury 1995). At most three planes are active at a time.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace tactus::coupling {

/// Half-space normal · (x − proxy) ≥ −gap.
struct ProxyPlane {
    Vec3 normal{0.0, 0.0, 1.0};
    double gap = 0.0;  ///< m between proxy and surface; negative: penetration
    /// The interpolated normal of a round surface there; zero where facets are flat.
    Vec3 shaded{0.0};
    std::size_t surface = 0;  ///< index of the surface that it belongs to
};

/// The contacts of a proxy: at most eight planes, the nearest ones.
class ProxyPlanes {
public:
    /// Neighbouring facets of a flat face are merged.
    void add(const ProxyPlane& one) noexcept;
    std::span<const ProxyPlane> all() const noexcept { return std::span(plane_).first(count_); }
    /// The same with interpolated normals where available.
    ProxyPlanes shaded() const noexcept;

private:
    static constexpr std::size_t most = 8;
    std::array<ProxyPlane, most> plane_;
    std::size_t count_ = 0;
};

/// By how much each plane pushes a point away from its goal: Lagrange multipliers, m; 0 of planes that it does not touch.
using PlanePushes = std::array<double, 8>;

/// The point nearest to `goal` in all half-spaces, with planes relative to `from`. Uses at most eight planes.
Vec3 nearest_within(const Vec3& goal, const Vec3& from, std::span<const ProxyPlane> planes,
                    PlanePushes* pushes = nullptr) noexcept;

}  // namespace tactus::coupling
