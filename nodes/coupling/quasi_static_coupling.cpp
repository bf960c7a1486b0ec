// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/quantile.hpp"
#include "dsp/coupling/guidance.hpp"
#include "dsp/coupling/quasi_static.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/contact_parameters.hpp"
#include "nodes/coupling/held_body.hpp"
#include "nodes/coupling/lead.hpp"
#include "nodes/coupling/solver_parameters.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tactus::nodes {

struct QuasiStaticCoupling {
    static constexpr auto about =
        "Quasi-static virtual coupling in six degrees of freedom: each tick solves for the pose of the held body in "
        "which the springs to the hand and the contact forces balance; the hand feels the springs. A second pair of "
        "springs can pull the body to a target; the hand can always overcome them.";

    In<Pose> device{"pose of the hand in the scene", "m"};
    In<tactus::coupling::Scene> scene{"the bodies, with the held one among them"};
    In<Pose> grip{optional, "pose of the held body in the frame of the hand; unconnected: 'grip_at'", "m"};
    In<bool> holding{optional, "false: the body stays where it was released; unconnected: true"};
    In<double> strength{
        optional,
        "share of the force that the hand feels, 0 to 1; unconnected: 1, and 0 from 0.1 s after 'holding' ended"};
    In<Pose> target{optional, of_world, "pose that the held body is pulled to while 'guided'", "m"};
    In<bool> guided{optional, "pull the body to the target; unconnected: false"};
    In<bool> has_target{optional, of_world, "the target is valid; unconnected: true"};
    In<double> target_of{optional, of_world, "place of the body that the target is for; unconnected: the held one"};
    In<bool> settle{optional, "the springs to the hand yield while the body is guided, so that the hand adds no bias"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<Pose> pose{"of the held body: the proxy", "m"};
    Out<double> place{"place of the held body in the scene; -1: none"};
    Out<double> penetration{"of the deepest point", "m"};
    Out<double> residual{"of the force balance", "N"};
    Out<bool> in_contact{"at least one point exerts a force"};
    Param held{discrete, "0", "-1", "15", "place of the held body in the scene; connect grasp.held"};
    Vector grip_at{"0 mm, 0 mm, 0 mm", "origin of the held body in the frame of the hand"};
    Param guide_stiffness{internal, "1 N/mm", "0 N/mm", "20 N/mm", "of the spring to the target"};
    Param guide_angular_stiffness{"1 N m/rad", "0 N m/rad", "100 N m/rad", "of the rotational spring to the target"};
    Param guide_force{"8 N", "0 N", "100 N", "limit of the force to the target"};
    Param guide_torque{"0.3 N m", "0 N m", "20 N m", "limit of the torque to the target"};
    LeadParameters led;
    SolverParameters solver;
    ContactParameters contact;

    std::vector<Visual> visuals() const {
        return {held_visual(held, grip_at),
                {.kind = VisualKind::led, .pose = "pose", .target = "target", .when = "guided"}};
    }

    void prepare(const Setup& setup) {
        contact_.emplace(contact.make(setup));
        guided_contact_.emplace(*contact_);
        place = -1.0;
    }

    void process(const Tick& tick) noexcept {
        hold_.update(scene, held, holding, strength, tick.elapsed_seconds());
        const Pose in_hand = grip.connected && is_valid(grip.get()) ? grip.get() : Pose{grip_at, {1.0, 0.0, 0.0, 0.0}};
        contact.set(*contact_, scene, hold_.place, in_hand);
        if (hold_.taken) take();
        guide(in_hand, tick.elapsed_seconds());
        solver.set(solver_.settings, *contact_, lead_.springs());
        solver_.settings.slip = lead_.slip();
        SolverParameters::slow_down(solver_.settings, solver_.state().proxy, device, tick.elapsed_seconds());
        if (hold_.holds) solve(in_hand);
        else let_go();
        place = hold_.place;
    }

    void report(Report& report) const {
        const auto share = [](double part, std::uint64_t whole) {
            return whole > 0 ? part / static_cast<double>(whole) : 0.0;
        };
        report.set("coupling", "residual_p99_N", residuals_.quantile(0.99));
        report.set("coupling", "residual_max_N", residuals_.greatest());
        report.set("coupling", "balanced", share(balanced_, ticks_));
        report.set("coupling", "penetration_max_mm", deepest_ * 1e3);
        report.set("coupling", "iterations_mean", share(iterations_, ticks_));
        report.set("coupling", "evaluations_mean", share(evaluations_, ticks_));
        report.set("coupling", "points_in_contact_max", max_points_);
        report.set("coupling", "in_contact", share(touching_, ticks_));
        report.set("coupling", "over_budget_ticks", reduced_);
    }

private:
    void take() noexcept {
        solver_.reset(device);
        lead_.take();
    }

    void guide(const Pose& in_hand, double elapsed) noexcept {
        coupling::GuidedContact& g = *guided_contact_;
        const bool is_its = !target_of.connected || target_of.get() == static_cast<double>(hold_.place);
        const bool wanted = hold_.holds && guided.connected && guided.get() && is_its &&
                            (!has_target.connected || has_target.get()) && target.connected && is_valid(target.get());
        lead_.update(led, device, wanted, hold_.holds && settle.connected && settle.get(), solver_.state().balanced,
                     elapsed);
        g.share = lead_.share();
        if (wanted) g.target = Pose{target->position, glm::normalize(target->orientation)} * in_hand.inverse();
        g.springs = {{guide_stiffness, guide_force}, {guide_angular_stiffness, guide_torque}};
    }

    void solve(const Pose& in_hand) noexcept {
        const coupling::QuasiStaticState& now = solver_.update(device, *guided_contact_);
        last_ = felt_of(now);
        wrench = last_ * hold_.strength;
        pose = now.proxy * in_hand;
        penetration = now.contact.penetration;
        residual = now.residual;
        in_contact = now.contact.in_contact > 0;
        ++ticks_;
        if (!now.is_slowed) residuals_.add(now.residual);
        deepest_ = std::max(deepest_, now.contact.penetration);
        max_points_ = std::max(max_points_, static_cast<double>(now.contact.in_contact));
        balanced_ += now.balanced ? 1.0 : 0.0;
        iterations_ += now.iterations;
        evaluations_ += now.evaluations;
        touching_ += now.contact.in_contact > 0 ? 1.0 : 0.0;
        reduced_ += now.contact.reduced ? 1.0 : 0.0;
    }

    /// Keeps the body where it is; its last force fades with the strength.
    void let_go() noexcept {
        wrench = last_ * hold_.strength;
        penetration = 0.0;
        residual = 0.0;
        in_contact = false;
        if (hold_.strength == 0.0) last_ = {};
    }

    std::optional<coupling::HeldContact> contact_;
    std::optional<coupling::GuidedContact> guided_contact_;
    Lead lead_;
    tactus::coupling::QuasiStaticCoupling solver_;
    Hold hold_;
    Wrench last_;
    SizeCounts residuals_;  // of the ticks that `slip` did not end early
    std::uint64_t ticks_ = 0;
    double deepest_ = 0.0, balanced_ = 0.0, iterations_ = 0.0, evaluations_ = 0.0, touching_ = 0.0, max_points_ = 0.0,
           reduced_ = 0.0;
};

TACTUS_NODE(QuasiStaticCoupling, device, scene, grip, holding, strength, target, guided, has_target, target_of, settle,
            wrench, pose, place, penetration, residual, in_contact, held, grip_at, guide_stiffness,
            guide_angular_stiffness, guide_force, guide_torque, led, solver, contact)
TACTUS_VISUALS(QuasiStaticCoupling)

}  // namespace tactus::nodes
