// SPDX-License-Identifier: Apache-2.0
// What the proxies share: what they touch, and their parameters.
#pragma once

#include "dsp/coupling/scene.hpp"
#include "dsp/coupling/surface_proxy.hpp"
#include "graph/node/node.hpp"

#include <array>
#include <span>

namespace tactus::nodes {

/// The bodies of a scene as a proxy sees them.
class ProxySurfaces {
public:
    ProxySurfaces(const coupling::Scene& scene, bool by_triangles) noexcept {
        for (std::size_t i = 0; i < scene.count; ++i) {
            const coupling::SceneObject& object = scene.objects[i];
            if (!is_valid(object.pose)) continue;
            if (by_triangles && object.body.triangles) list_[count_++] = {nullptr, object.body.triangles, object.pose};
            if (!by_triangles && object.body.map) list_[count_++] = {object.body.map, nullptr, object.pose};
        }
    }
    std::span<const coupling::ProxySurface> span() const noexcept { return std::span(list_).first(count_); }

private:
    std::array<coupling::ProxySurface, coupling::Scene::most_objects> list_;
    std::size_t count_ = 0;
};

struct ProxyParameters {
    Choice surface{{"field", "triangles"}, "what is touched: the distance field, or the triangles"};
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "of the spring between hand and proxy"};
    Param max_force{"10 N", "0 N", "100 N", "the spring pulls no harder"};
    Param static_friction{"0", "0", "2", "coefficient of friction while it sticks"};
    Param dynamic_friction{"0", "0", "2", "coefficient while it slides; at most the static one"};
    Param texture_height{"0 mm", "0 mm", "2 mm", "of waves that stand on the surface, from their mean to the top"};
    Param texture_length{"2 mm", "0.1 mm", "100 mm", "of a wave, along each axis of a body"};
    Param step{
        "0.25 mm", "0.001 mm", "10 mm",
        "farthest move along a field at a time; at most half of its thinnest wall, and half a voxel in any case"};
    Flag shading{true, "forces over round triangle meshes are those of a round surface, not of its facets"};
    TACTUS_GROUP(surface, stiffness, max_force, static_friction, dynamic_friction, texture_height, texture_length, step,
                 shading)

    /// One tick of a proxy of that radius, m: towards the place of `device` as far as the scene lets it.
    const coupling::ProxyState& update(coupling::SurfaceProxy& proxy, double radius, const Pose& device,
                             const coupling::Scene& scene) const noexcept {
        proxy.settings = {{radius, texture_height, texture_length, step},
                          stiffness,
                          max_force,
                          static_friction,
                          dynamic_friction,
                          shading};
        return proxy.update(device.position, ProxySurfaces(scene, surface.index == 1).span());
    }
};

}  // namespace tactus::nodes
