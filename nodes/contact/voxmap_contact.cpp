// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/held_contact.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/contact_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::nodes {

struct VoxmapContact {
    static constexpr auto about =
        "Pointshell contact of one body of a scene with the distance fields of all others, at a given pose; the force "
        "is proportional to depth. For use without a coupling node; coupling nodes compute their own contact.";

    In<Pose> pose{"of the body", "m"};
    In<tactus::coupling::Scene> scene{"the bodies"};
    Out<Wrench> wrench{"on the body, about its origin", "N, N m"};
    Out<double> stiffness{
        "of all touching points together, along the stiffest of the three axes; with 'saturation' at least the force "
        "over "
        "its depth, so that a saturated contact has a stiffness",
        "N/m"};
    Out<double> penetration{"of the deepest point", "m"};
    Out<bool> in_contact{"at least one point exerts a force"};
    Param held{discrete, "0", "-1", "15", "place of the body in the scene"};
    ContactParameters contact;

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::held,
                 .scene = "scene",
                 .place = "held",
                 .pose = "pose",
                 .force = "wrench",
                 .held = held}};
    }

    void prepare(const Setup& setup) { contact_.emplace(contact.make(setup)); }

    void process(const Tick&) noexcept {
        contact.set(*contact_, scene, static_cast<int>(held), {});
        const contact::ContactSum now =
            is_valid(pose.get()) ? (*contact_)(pose, contact::ContactParts::all) : contact::ContactSum{};
        wrench = now.wrench();
        stiffness = std::max({now.stiffness[0], now.stiffness[7], now.stiffness[14], contact.secant(now)});
        penetration = now.penetration;
        in_contact = now.in_contact > 0;
        deepest_ = std::max(deepest_, now.penetration);
    }

    void report(Report& report) const { report.set("contact", "penetration_max_mm", deepest_ * 1e3); }

private:
    std::optional<coupling::HeldContact> contact_;
    double deepest_ = 0.0;
};

TACTUS_NODE(VoxmapContact, pose, scene, wrench, stiffness, penetration, in_contact, held, contact)
TACTUS_VISUALS(VoxmapContact)

}  // namespace tactus::nodes
