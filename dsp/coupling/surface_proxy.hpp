// SPDX-License-Identifier: Apache-2.0
// Three-degree-of-freedom proxies: a point or a ball that stays outside of what the hand enters (thesis 2.4.2–2.4.3).
//
// The proxy goes from where it was towards the hand as far as surfaces let it, so it stays on the side it came from and
// the force, a spring from hand to proxy, never turns over. Near a surface it solves for the nearest place to the hand
// within the half-spaces of all that it touches (god-object: Zilles and Salisbury 1995; ball: Ruspini, Kolarov and
// Khatib 1997). Friction is a cone about that place; texture moves the surface up and down.
#pragma once

#include "dsp/contact/voxmap.hpp"
#include "dsp/core/types.hpp"
#include "dsp/coupling/triangle_tree.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace tactus {

/// One surface: a distance field, or triangles when there are any.
struct ProxySurface {
    const Voxmap* map = nullptr;
    const TriangleTree* triangles = nullptr;
    Pose pose;
};

struct ProxySettings {
    double radius = 0.0;  ///< m, of the ball; a point is held a micrometre off the surface
    double stiffness = 1000.0;  ///< N/m, between hand and proxy
    double max_force = 10.0;  ///< N
    double static_friction = 0.0, dynamic_friction = 0.0;  ///< coefficients; the second is at most the first
    double texture_height = 0.0;  ///< m, of the surface's waves, from their mean to the top
    double texture_length = 2e-3;  ///< m, of a wave, along each axis of the body
    double step = 0.25e-3;  ///< m: half of the thinnest wall of a distance field at most
};

struct ProxyState {
    Vec3 proxy{0.0};
    Vec3 force{0.0};  ///< N, on the hand
    Vec3 normal{0.0};  ///< of what is touched, unit; zero when free
    bool in_contact = false;
    bool sticks = false;  ///< friction holds it
};

/// A half-space that the proxy may be in: normal · (x − place of the proxy) ≥ −gap.
struct ProxyPlane {
    Vec3 normal{0.0, 0.0, 1.0};
    double gap = 0.0;  ///< m between ball and surface
};

/// The point nearest to `goal` in all half-spaces, planes counted from `from`. At most eight planes are heeded.
Vec3 nearest_within(const Vec3& goal, const Vec3& from, std::span<const ProxyPlane> planes) noexcept;

class SurfaceProxy {
public:
    ProxySettings settings;

    void reset(const Vec3& at) noexcept;
    /// Leads the proxy towards `goal`, m in the frame of the surfaces' poses. A goal that is no place leaves all as it was.
    const ProxyState& update(const Vec3& goal, std::span<const ProxySurface> surfaces) noexcept;
    const ProxyState& state() const noexcept { return state_; }

private:
    static constexpr std::size_t most_planes = 8;
    struct Planes {
        std::array<ProxyPlane, most_planes> plane;
        std::size_t count = 0;
        void add(const ProxyPlane& one) noexcept;
    };

    double radius() const noexcept;
    Planes touched(const Vec3& at, std::span<const ProxySurface> surfaces) const noexcept;
    ProxyPlane textured(const ProxySurface& surface, const Vec3& point, ProxyPlane plane) const noexcept;
    /// How far it may go from `at` along the unit vector `way`, at most `length`.
    double free_way(const Vec3& at, const Vec3& way, double length,
                    std::span<const ProxySurface> surfaces) const noexcept;
    Vec3 lead(Vec3 from, const Vec3& goal, std::span<const ProxySurface> surfaces) const noexcept;

    ProxyState state_;
    bool started_ = false;
};

}  // namespace tactus
