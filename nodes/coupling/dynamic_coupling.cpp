// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/dynamic_coupling.hpp"

#include "dsp/core/rotation.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/contact_parameters.hpp"
#include "nodes/coupling/held_body.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>

namespace tactus::nodes {

struct DynamicCoupling {
    static constexpr auto about =
        "Dynamic virtual coupling: springs and dampers pull a body with mass to the hand, and contact pushes it. One "
        "implicit Euler step per tick.";

    In<Pose> device{"pose of the hand in the scene", "m"};
    In<tactus::coupling::Scene> scene{"the bodies, with the held one among them"};
    In<Twist> device_twist{optional, "velocity of the hand in the scene; unconnected: from its poses", "m/s, rad/s"};
    In<Pose> grip{optional, "pose of the held body in the frame of the hand; unconnected: 'grip_at'", "m"};
    In<bool> holding{optional, "false: the body stays where it was released; unconnected: true"};
    In<double> strength{
        optional,
        "share of the force that the hand feels, 0 to 1; unconnected: 1, and 0 from 0.1 s after 'holding' ended"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<Pose> pose{"of the held body", "m"};
    Out<double> place{"place of the held body in the scene; -1: none"};
    Out<double> penetration{"of the deepest point", "m"};
    Out<bool> in_contact{"at least one point exerts a force"};
    Param held{discrete, "0", "-1", "15", "place of the held body in the scene; connect grasp.held"};
    Vector grip_at{"0 mm, 0 mm, 0 mm", "origin of the held body in the frame of the hand"};
    Param mass{"100 g", "0.1 g", "100 kg", "of the body"};
    Param inertia{"1e-4 kg m^2", "1e-9 kg m^2", "100 kg m^2", "of the body, about every axis through the hand"};
    Param stiffness{"1 N/mm", "0 N/mm", "20 N/mm", "of the spring to the hand"};
    Param damping{"10 N s/m", "0 N s/m", "500 N s/m", "of the damper to the hand"};
    Param angular_stiffness{"1 N m/rad", "0 N m/rad", "100 N m/rad", "of the rotational spring"};
    Param angular_damping{"0.01 N m s/rad", "0 N m s/rad", "10 N m s/rad", "of the rotational damper"};
    Param max_force{"10 N", "0 N", "100 N", "limit of the spring force"};
    Param max_torque{"0.5 N m", "0 N m", "20 N m", "limit of the spring torque"};
    Param step{
        "0.5 mm", "0.05 mm", "20 mm",
        "limit of a point's motion beyond the free distance, eight times in a tick; never more than half a "
        "voxel of the finest field that is touched. A lower one would hold the body back until it comes free, and "
        "let the force jump then"};
    ContactParameters contact;

    std::vector<Visual> visuals() const { return {held_visual(held, grip_at)}; }

    void prepare(const Setup& setup) {
        contact_.emplace(contact.make(setup));
        place = -1.0;
    }

    void process(const Tick& tick) noexcept {
        hold_.update(scene, held, holding, strength, tick.elapsed_seconds());
        const Pose in_hand = grip.connected && is_valid(grip.get()) ? grip.get() : Pose{grip_at, {1.0, 0.0, 0.0, 0.0}};
        contact.set(*contact_, scene, hold_.place, in_hand);
        solver_.settings = {{{stiffness, max_force}, {angular_stiffness, max_torque}},
                            mass,
                            inertia,
                            damping,
                            angular_damping,
                            std::min(step.value, contact_->safe_step()),
                            contact_->reach()};
        if (hold_.taken) {
            solver_.reset(device);
            last_hand_ = device;
        }
        place = hold_.place;
        if (!hold_.holds) {
            wrench = last_ * hold_.strength;
            in_contact = false;
            penetration = 0.0;
            return;
        }
        const Twist velocity =
            device_twist.connected ? device_twist.get() : velocity_from_poses(tick.elapsed_seconds());
        const coupling::DynamicState& now = solver_.update(device, velocity, seconds(tick.period), *contact_);
        last_ = felt_of(now);
        wrench = last_ * hold_.strength;
        pose = now.proxy * in_hand;
        penetration = now.contact.penetration;
        in_contact = now.contact.in_contact > 0;
        deepest_ = std::max(deepest_, now.contact.penetration);
    }

    void report(Report& report) const { report.set("coupling", "penetration_max_mm", deepest_ * 1e3); }

private:
    /// A damper to a hand that is taken as still would give energy to a hand that moves.
    Twist velocity_from_poses(double elapsed) noexcept {
        const Pose before = last_hand_;
        if (!is_valid(device.get())) return {};
        last_hand_ = device;
        if (!is_valid(before) || !(elapsed > 0.0)) return {};
        const Twist velocity{(device->position - before.position) / elapsed,
                             rotation_between(before.orientation, device->orientation) / elapsed};
        // No hand is as fast: the device has jumped, and a damper would answer with a blow.
        constexpr double fastest = 5.0, fastest_turn = 100.0;  // m/s, rad/s
        const bool jumped = !(glm::length(velocity.linear) < fastest && glm::length(velocity.angular) < fastest_turn);
        return jumped ? Twist{} : velocity;
    }

    std::optional<coupling::HeldContact> contact_;
    tactus::coupling::DynamicCoupling solver_;
    Hold hold_;
    Wrench last_;
    Pose last_hand_;
    double deepest_ = 0.0;
};

TACTUS_NODE(DynamicCoupling, device, scene, device_twist, grip, holding, strength, wrench, pose, place, penetration,
            in_contact, held, grip_at, mass, inertia, stiffness, damping, angular_stiffness, angular_damping, max_force,
            max_torque, step, contact)
TACTUS_VISUALS(DynamicCoupling)

}  // namespace tactus::nodes
