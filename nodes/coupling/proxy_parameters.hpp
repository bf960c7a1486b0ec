// SPDX-License-Identifier: Apache-2.0
// Surfaces of a scene and parameters, common to the proxy nodes.
#pragma once

#include "dsp/coupling/scene.hpp"
#include "dsp/coupling/surface_proxy.hpp"
#include "graph/node/node.hpp"

#include <array>
#include <span>

namespace tactus::nodes {

/// The surfaces of a scene's bodies.
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
    std::array<coupling::ProxySurface, coupling::Scene::max_objects> list_;
    std::size_t count_ = 0;
};

struct ProxyParameters {
    Choice surface{{"field", "triangles"}, "surface of a body: zero level of its distance field, or its triangles"};
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "of the spring between hand and proxy"};
    Param max_force{"10 N", "0 N", "100 N", "limit of the spring force"};
    Param static_friction{"0", "0", "2", "coefficient of static friction"};
    Param dynamic_friction{"0", "0", "2", "coefficient of sliding friction; at most the static one"};
    Param texture_height{"0 mm", "0 mm", "2 mm",
                         "of a wave texture on the surface, from mean to crest; the mean is the surface. Counts up to "
                         "0.2 of 'texture_length', a slope of 0.9"};
    Param texture_length{"2 mm", "0.1 mm", "100 mm", "wavelength of the texture along each axis of a body"};
    Param step{"0.25 mm", "0.001 mm", "10 mm",
               "step length along a distance field; at most half of its thinnest wall; never more than half a voxel"};
    Flag shading{true, "force shading: forces on round triangle meshes follow interpolated normals"};
    TACTUS_GROUP(surface, stiffness, max_force, static_friction, dynamic_friction, texture_height, texture_length, step,
                 shading)

    /// One tick of a proxy with `radius` m: moves it towards the position of `device` as far as the scene permits.
    const coupling::ProxyState& update(coupling::SurfaceProxy& proxy, double radius, const Pose& device,
                                       const coupling::Scene& scene) const noexcept {
        proxy.settings = {
            {radius, step}, {texture_height, texture_length}, stiffness, max_force, static_friction, dynamic_friction,
            shading};
        return proxy.update(device.position, ProxySurfaces(scene, surface.index == 1).span());
    }
};

}  // namespace tactus::nodes
