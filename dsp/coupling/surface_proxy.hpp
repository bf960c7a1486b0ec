// SPDX-License-Identifier: Apache-2.0
// Three-degree-of-freedom proxies: a point or a ball that stays outside of bodies that the hand enters (thesis
// 2.4.2–2.4.3).
//
// The proxy moves from its last position towards the hand as far as surfaces permit, so it stays on the side it came
// from and the spring force from hand to proxy never reverses. In contact it moves to the point nearest to the hand
// within the half-spaces of all touched surfaces (god-object: Zilles and Salisbury 1995; ball and force shading:
// Ruspini, Kolarov and Khatib 1997). No move passes through a surface, however far the hand has jumped.
//
// Texture is no part of that surface: a god object on waves stays in a trough until it is past the next crest, and then
// jumps, as soon as the hand is deeper below the surface than the crests are round. Instead the waves lengthen and shorten
// the spring. The proxy moves on the smooth envelope of the crests, at the distance D from the hand, and the energy is
// ½·K·g², with g = D − height + lift at the proxy. Its force, K·g along the normal and −K·g·slope along the surface, is a
// continuous function of the hand's position, however deep the hand is, and on flat faces the gradient of that energy. On a
// surface of curvature κ the second part is short by a share κ·D: what that gives or takes on a closed path is bounded by the
// energy cap of device_output.
//
// Friction is a cone about that point (Harwin and Melder 2002): the proxy stays where it is while it lies inside of the
// cone, and otherwise follows to its rim. The cone has a state: it is that of static friction until the proxy slides,
// narrows to that of sliding over a distance, and opens again once the proxy lies well inside. Without the state each
// tick that slides is followed by ticks that stick, and the mean lies between the two coefficients. The narrowing over a
// distance keeps the force continuous.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/coupling/proxy_surface.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus::coupling {

struct ProxySettings {
    ProxyShape shape;  ///< a point is a ball of a micrometre
    ProxyTexture texture;
    double stiffness = 1000.0;  ///< N/m, between hand and proxy
    double max_force = 10.0;  ///< N
    double static_friction = 0.0, dynamic_friction = 0.0;  ///< coefficients; the second is at most the first
    bool shading = true;  ///< force shading: forces on round triangle meshes follow interpolated normals
};

struct ProxyState {
    Vec3 proxy{0.0};  ///< m, on the waves of the texture
    Vec3 force{0.0};  ///< N, on the hand
    Vec3 normal{0.0};  ///< of the touched surface, unit; zero when free
    bool in_contact = false;
    bool sticks = false;  ///< static friction holds it
};

class SurfaceProxy {
public:
    static constexpr std::size_t max_surfaces = 8;
    /// Triangles that one update tests at most. A proxy that needs more stays where it has proven space to be free, and
    /// goes on from there in the next update.
    static constexpr std::int64_t max_triangles = 6400;

    ProxySettings settings;

    void reset(const Vec3& at) noexcept;
    /// Moves the proxy towards `goal`, m in the frame of the surfaces' poses. Ignores a goal that is not finite. Uses
    /// the first eight surfaces. A surface whose pose changes carries the proxy along and does not pass over it.
    const ProxyState& update(const Vec3& goal, std::span<const ProxySurface> surfaces) noexcept;
    const ProxyState& state() const noexcept { return state_; }
    /// Triangles that the last update tested.
    std::int64_t tested() const noexcept { return max_triangles - budget_.triangles; }

private:
    static constexpr double far = 1e3, unset = -1.0;

    struct View {
        ProxyPlanes planes;
        std::array<ProxySurface::Level, max_surfaces> levels;
        double deepest = 0.0;  ///< m, greatest penetration of the proxy
    };

    View look(const Vec3& at, std::span<const ProxySurface> surfaces) noexcept;
    /// The texture below a proxy at `at` that is pushed away from `goal` by the planes that the last `lead` has seen there.
    ProxyTexture::Lift lift(const Vec3& at, const Vec3& goal, std::span<const ProxySurface> surfaces) const noexcept;
    /// Projects out of fields that a move has entered.
    Vec3 settle(Vec3 at, std::span<const ProxySurface> surfaces) noexcept;
    /// False when the line between the two positions crosses a wall of a field.
    bool is_open(const Vec3& a, const View& from, const Vec3& b, const View& to,
                 std::span<const ProxySurface> surfaces) noexcept;
    Vec3 lead(Vec3 from, const Vec3& goal, std::span<const ProxySurface> surfaces) noexcept;
    void follow(std::span<const ProxySurface> surfaces) noexcept;
    /// How much of a proxy's distance `behind` the frictionless position friction keeps, m, at `depth` m below it.
    double held_back(double behind, double depth) noexcept;

    ProxyShape shape_;  // up to the crests of the texture
    Vec3 at_{0.0};  // m, of the proxy on the envelope of the crests
    ProxySurface::Budget budget_;  // of this update
    View last_view_;  // where the last `lead` ended
    bool has_view_ = false;  // false: no triangles were left for it
    ProxyTexture::Lift wave_;  // below the proxy
    double stride_ = far;  // m: longest move that is tried, on triangles
    double friction_ = unset;  // coefficient now; unset: that of static friction
    ProxyState state_;
    bool started_ = false;
    std::array<ProxySurface, max_surfaces> seen_;  ///< of the last update
    std::size_t seen_count_ = 0;
};

}  // namespace tactus::coupling
