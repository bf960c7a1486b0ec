// SPDX-License-Identifier: Apache-2.0
// Half-spaces that a proxy may be in, and the place in all of them that is nearest to the hand: the constraint set of
// the god-object (Zilles and Salisbury 1995), at most three of which bind at a time.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace tactus::coupling {

/// normal · (x − place of the proxy) ≥ −gap.
struct ProxyPlane {
    Vec3 normal{0.0, 0.0, 1.0};
    double gap = 0.0;  ///< m between proxy and surface; below zero when it reaches in
    /// The normal that the surface would have there if its facets were round; zero where they are meant to be flat.
    Vec3 shaded{0.0};
};

/// What a proxy touches: at most eight planes, the nearest ones.
class ProxyPlanes {
public:
    /// Neighbouring facets of a flat face count as one.
    void add(const ProxyPlane& one) noexcept;
    std::span<const ProxyPlane> all() const noexcept { return std::span(plane_).first(count_); }
    /// The same with shaded normals where there are any.
    ProxyPlanes shaded() const noexcept;

private:
    static constexpr std::size_t most = 8;
    std::array<ProxyPlane, most> plane_;
    std::size_t count_ = 0;
};

/// The point nearest to `goal` in all half-spaces, planes counted from `from`. At most eight planes are heeded.
Vec3 nearest_within(const Vec3& goal, const Vec3& from, std::span<const ProxyPlane> planes) noexcept;

}  // namespace tactus::coupling
