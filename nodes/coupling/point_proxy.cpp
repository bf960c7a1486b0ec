// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/coupling/proxy_parameters.hpp"

namespace tactus::nodes {

struct PointProxy {
    static constexpr auto about =
        "God-object (Zilles and Salisbury 1995): a point that stays outside of all bodies while the hand moves into "
        "them, and a spring between the two.";

    In<Pose> device{"pose of the hand in the scene; only its position is used", "m"};
    In<tactus::coupling::Scene> scene{"the bodies"};
    Out<Wrench> wrench{"on the hand, about its origin; no torque", "N, N m"};
    Out<Pose> proxy{"position of the proxy, with the orientation of the hand", "m"};
    Out<bool> in_contact{"the proxy touches a body"};
    ProxyParameters parameters;

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::ball, .pose = "proxy", .hand = "device", .force = "wrench", .radius = 0.5e-3}};
    }

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
TACTUS_VISUALS(PointProxy)

}  // namespace tactus::nodes
