// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "nodes/coupling/proxy_parameters.hpp"

namespace tactus::nodes {

struct PointProxy {
    static constexpr auto about =
        "A point that stays outside of everything while the hand goes in, and a spring between the two: the "
        "god-object.";

    In<Pose> device{"the hand in the scene; only its place counts", "m"};
    In<tactus::coupling::Scene> scene{"everything that can be touched"};
    Out<Wrench> wrench{"on the hand, about its origin; no torque", "N, N m"};
    Out<Pose> proxy{"where the hand would be if it could not go in", "m"};
    Out<bool> in_contact{"it touches something"};
    ProxyParameters parameters;

    void process(const Tick&) noexcept {
        const coupling::ProxyState& now = parameters.update(solver_, 0.0, device, scene);
        wrench = {now.force, Vec3(0.0)};
        proxy = {now.proxy, is_valid(device.get()) ? device->orientation : Quat(1.0, 0.0, 0.0, 0.0)};
        in_contact = now.in_contact;
    }

private:
    coupling::SurfaceProxy solver_;
};

TACTUS_NODE(PointProxy, device, scene, wrench, proxy, in_contact, parameters)

}  // namespace tactus::nodes
