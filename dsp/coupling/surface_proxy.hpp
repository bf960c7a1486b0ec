// SPDX-License-Identifier: Apache-2.0
// Three-degree-of-freedom proxies: a point or a ball that stays outside of what the hand enters (thesis 2.4.2–2.4.3).
//
// The proxy goes from where it was towards the hand as far as surfaces let it, so it stays on the side it came from and
// the force, a spring from hand to proxy, never turns over. Where it touches something it goes on to the place nearest
// to the hand within the half-spaces of all that it touches (god-object: Zilles and Salisbury 1995; ball and shading of
// facets: Ruspini, Kolarov and Khatib 1997), and no move goes through a surface, however far the hand has jumped.
// Friction is a cone about that place; texture is waves that stand on the surface.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/coupling/proxy_surface.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace tactus::coupling {

struct ProxySettings {
    ProxyShape shape;  ///< a point is a ball of a micrometre
    double stiffness = 1000.0;  ///< N/m, between hand and proxy
    double max_force = 10.0;  ///< N
    double static_friction = 0.0, dynamic_friction = 0.0;  ///< coefficients; the second is at most the first
    bool shading = true;  ///< facets of round triangle meshes feel round: forces along interpolated normals
};

struct ProxyState {
    Vec3 proxy{0.0};
    Vec3 force{0.0};  ///< N, on the hand
    Vec3 normal{0.0};  ///< of what is touched, unit; zero when free
    bool in_contact = false;
    bool sticks = false;  ///< friction holds it
};

class SurfaceProxy {
public:
    static constexpr std::size_t most_surfaces = 8;

    ProxySettings settings;

    void reset(const Vec3& at) noexcept;
    /// Leads the proxy towards `goal`, m in the frame of the surfaces' poses. A goal that is no place leaves all as it
    /// was. The first eight surfaces are heeded. One whose pose changes takes the proxy along and does not pass over it.
    const ProxyState& update(const Vec3& goal, std::span<const ProxySurface> surfaces) noexcept;
    const ProxyState& state() const noexcept { return state_; }

private:
    struct View {
        ProxyPlanes planes;
        std::array<ProxySurface::Level, most_surfaces> levels;
        double deepest = 0.0;  ///< m, of what the proxy reaches into
    };

    View look(const Vec3& at, std::span<const ProxySurface> surfaces) const noexcept;
    /// Back out of fields that a move has gone into.
    Vec3 settle(Vec3 at, std::span<const ProxySurface> surfaces) const noexcept;
    /// False when the way between the two places leads through a wall of a field.
    bool is_open(const Vec3& a, const View& from, const Vec3& b, const View& to,
                 std::span<const ProxySurface> surfaces) const noexcept;
    Vec3 lead(Vec3 from, const Vec3& goal, std::span<const ProxySurface> surfaces) const noexcept;
    void follow(std::span<const ProxySurface> surfaces) noexcept;

    ProxyShape shape_;
    ProxyState state_;
    bool started_ = false;
    std::array<ProxySurface, most_surfaces> seen_;  ///< of the last update
    std::size_t seen_count_ = 0;
};

}  // namespace tactus::coupling
