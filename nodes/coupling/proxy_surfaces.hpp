// SPDX-License-Identifier: Apache-2.0
// The bodies of a scene as a proxy sees them.
#pragma once

#include "dsp/coupling/scene.hpp"
#include "dsp/coupling/surface_proxy.hpp"

#include <array>
#include <span>

namespace tactus::nodes {

class ProxySurfaces {
public:
    ProxySurfaces(const Scene& scene, bool by_triangles) noexcept {
        for (std::size_t i = 0; i < scene.count; ++i) {
            const SceneObject& object = scene.objects[i];
            if (!is_valid(object.pose)) continue;
            if (by_triangles && object.body.triangles) list_[count_++] = {nullptr, object.body.triangles, object.pose};
            if (!by_triangles && object.body.map) list_[count_++] = {object.body.map, nullptr, object.pose};
        }
    }
    std::span<const ProxySurface> span() const noexcept { return std::span(list_).first(count_); }

private:
    std::array<ProxySurface, Scene::most_objects> list_;
    std::size_t count_ = 0;
};

}  // namespace tactus::nodes
