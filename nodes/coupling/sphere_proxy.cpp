// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/coupling/proxy_parameters.hpp"

namespace tactus::nodes {

struct SphereProxy {
    static constexpr auto about =
        "A ball that stays outside of all bodies while the hand moves into them, and a spring between the two "
        "(Ruspini, Kolarov and Khatib 1997). It cannot enter a gap narrower than itself.";

    In<Pose> device{"pose of the hand in the scene; only its position is used", "m"};
    In<tactus::coupling::Scene> scene{"the bodies"};
    Out<Wrench> wrench{"on the hand, about its origin; no torque", "N, N m"};
    Out<Pose> proxy{"position of the ball's centre, with the orientation of the hand", "m"};
    Out<bool> in_contact{"the ball touches a body"};
    Param radius{"2 mm", "0.01 mm", "100 mm", "of the ball"};
    ProxyParameters parameters;

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::ball, .pose = "proxy", .hand = "device", .force = "wrench", .radius = radius}};
    }

    void process(const Tick&) noexcept {
        const coupling::ProxyState& now = parameters.update(solver_, radius, device, scene);
        wrench = {now.force, Vec3(0.0)};
        proxy = {now.proxy, is_valid(device.get()) ? device->orientation : Quat(1.0, 0.0, 0.0, 0.0)};
        in_contact = now.in_contact;
    }

private:
    coupling::SurfaceProxy solver_;
};

TACTUS_NODE(SphereProxy, device, scene, wrench, proxy, in_contact, radius, parameters)
TACTUS_VISUALS(SphereProxy)

}  // namespace tactus::nodes
