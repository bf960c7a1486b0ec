// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/scene.hpp"
#include "dsp/coupling/surface_proxy.hpp"
#include "graph/node.hpp"
#include "nodes/coupling/proxy_surfaces.hpp"

namespace tactus::nodes {

struct PointProxy {
    static constexpr auto about =
        "A point that stays outside of everything while the hand goes in, and a spring between the two: the "
        "god-object.";

    In<Pose> device{"the hand in the scene; only its place counts", "m"};
    In<tactus::Scene> scene{"everything that can be touched"};
    Out<Wrench> wrench{"on the hand, about its origin; no torque", "N, N m"};
    Out<Pose> proxy{"where the hand would be if it could not go in", "m"};
    Out<bool> in_contact{"it touches something"};
    Choice surface{{"field", "triangles"}, "what is touched: the distance field, or the triangles"};
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "of the spring between hand and proxy"};
    Param max_force{"10 N", "0 N", "100 N", "the spring pulls no harder"};
    Param static_friction{"0", "0", "2", "coefficient of friction while it sticks"};
    Param dynamic_friction{"0", "0", "2", "coefficient while it slides; at most the static one"};
    Param texture_height{"0 mm", "0 mm", "2 mm", "of waves on the surface, from their mean to the top"};
    Param texture_length{"2 mm", "0.1 mm", "100 mm", "of a wave, along each axis of a body"};
    Param step{"0.25 mm", "0.001 mm", "10 mm", "at most half of the thinnest wall of a field"};

    void process(const Tick&) noexcept {
        solver_.settings = {
            0.0, stiffness, max_force, static_friction, dynamic_friction, texture_height, texture_length, step};
        ProxySurfaces surfaces(scene, surface.index == 1);
        const ProxyState& now = solver_.update(device->position, surfaces.span());
        wrench = {now.force, Vec3(0.0)};
        proxy = {now.proxy, is_valid(device.get()) ? device->orientation : Quat(1.0, 0.0, 0.0, 0.0)};
        in_contact = now.in_contact;
    }

private:
    SurfaceProxy solver_;
};

TACTUS_NODE(PointProxy, device, scene, wrench, proxy, in_contact, surface, stiffness, max_force, static_friction,
            dynamic_friction, texture_height, texture_length, step)

}  // namespace tactus::nodes
