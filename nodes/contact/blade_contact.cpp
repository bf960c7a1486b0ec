// SPDX-License-Identifier: Apache-2.0
#include "dsp/contact/blade.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/tool_parameters.hpp"

#include <algorithm>
#include <optional>

namespace tactus::nodes {

struct BladeContact {
    static constexpr auto about =
        "Contact forces on a saw blade in a bone, from 132 points on its tooth edge and faces (thesis 6.2.2).";

    In<Pose> pose{"of the blade: x along the stroke, y into the bone, origin in the middle of the tooth edge"};
    In<volume::BoneSnapshot> bone{"the carved bone"};
    Out<Wrench> wrench{"on the blade, about its origin", "N"};
    Out<double> load{"thrust against the cutting direction", "N"};
    Out<double> penetration{"of the deepest point", "m"};
    Out<bool> in_contact{"the thrust or the force passed 'contact_on' and has not fallen below 'contact_off'"};
    Param stiffness{"0.8 N/mm", "0.01 N/mm", "50 N/mm",
                    "upper bound of the stiffness that the hand feels, for any number of points in contact"};
    ContactThreshold threshold;
    Param length{structural, "40 mm", "5 mm", "200 mm", "of the tooth edge"};
    Param height{structural, "10 mm", "1 mm", "100 mm", "of the blade, from the teeth back"};
    Param thickness{structural, "0.7 mm", "0.1 mm", "5 mm", "of the blade; the kerf is a little wider"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::blade,
                 .pose = "pose",
                 .force = "wrench",
                 .size = {length.value, height.value, thickness.value}}};
    }

    void prepare(const Setup&) { points_.emplace(contact::BladeShape{length, height, thickness}); }

    void process(const Tick&) noexcept {
        const tactus::contact::BladeContact now =
            contact::blade_contact(bone.get(), *points_, pose.get(), pose->position, stiffness);
        wrench = now.wrench;
        load = now.load;
        penetration = now.penetration;
        const bool touches = threshold.update(touch_, std::max(now.load, glm::length(now.wrench.force)));
        in_contact = touches;
        ++ticks_;
        if (!touches) return;
        ++touching_;
        thrust_ += now.load;
        deepest_ = std::max(deepest_, now.penetration);
    }

    void report(Report& report) const {
        const auto share = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
        report.set("contact", "fraction", share(touching_, ticks_));
        report.set("contact", "max_penetration_mm", deepest_ * 1e3);
        report.set("force", "thrust_mean_N", share(thrust_, touching_));
    }

private:
    std::optional<contact::BladePoints> points_;
    contact::ContactSwitch touch_;
    double ticks_ = 0.0, touching_ = 0.0, thrust_ = 0.0, deepest_ = 0.0;
};

TACTUS_NODE(BladeContact, pose, bone, wrench, load, penetration, in_contact, stiffness, threshold, length, height,
            thickness)
TACTUS_VISUALS(BladeContact)

}  // namespace tactus::nodes
