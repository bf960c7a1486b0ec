// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "graph/node/node.hpp"
#include "graph/node/task_asset.hpp"
#include "nodes/contact/body_parts.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace tactus::nodes {

struct GuideSeat {
    static constexpr auto about =
        "Seats a held cutting guide on the bone. Within 'reach' and 'reach_angle' of its seat the guide is pulled to "
        "it; after 'dwell' within both tolerances it is fixed where it is, and the hand is free for the saw. 'offset' "
        "is "
        "its remaining deviation from the seat, by which saw_blade moves the slots. Wire 'held', 'grip', 'target', "
        "'near', 'holding' and 'strength' to a coupling, and the coupling's pose back as delay 1. Without a guide, "
        "'seated' is always true.";

    In<Pose> hand{"pose of the hand in the scene: plan_frame.placed", "m"};
    In<Pose> moved{"of the held guide: coupling.pose as delay 1", "m"};
    In<double> place{"of the body that 'moved' is of: coupling.place as delay 1; below 0: none yet"};
    Out<coupling::Body> body{"the guide, for a scene"};
    Out<Pose> pose{"of the guide, for a scene", "m"};
    Out<double> held{"place 1 of the scene until the force has faded; -1: none; for coupling.held"};
    Out<Pose> grip{"of the guide in the frame of the hand", "m"};
    Out<Pose> target{"the seat", "m"};
    Out<bool> near{"the guide is drawn to the seat"};
    Out<bool> holding{"the hand holds the guide"};
    Out<double> strength{"share of the coupling's force that the hand feels, 0 to 1"};
    Out<bool> seated{"the guide is on the bone, and the hand free for the saw"};
    Out<Pose> offset{"of the seated guide from its plan, for saw_blade.guide_offset; before that none", "m"};
    Out<double> distance{"of the guide from its seat", "m"};
    Out<double> angle{"between the guide and its seat", "rad"};
    Asset<training::Task> task{"the task"};
    Param lift{structural, "20 mm", "0 mm", "200 mm", "height of the guide above its seat at the start"};
    Param spacing{structural, "1 mm", "0.3 mm", "10 mm", "of the points of the guide that touch bone"};
    Param reach{"4 mm", "0 mm", "50 mm", "the guide is pulled to its seat below this distance"};
    Param reach_angle{"10 deg", "0 deg", "90 deg", "and below this angle to the seat"};
    Param tolerance{"0.5 mm", "0.01 mm", "10 mm", "distance from the seat that counts as seated"};
    Param angle_tolerance{"1 deg", "0.05 deg", "45 deg", "angle to the seat that counts as seated"};
    Param dwell{"0.3 s", "0 s", "10 s", "time within both tolerances until the guide is seated"};
    Param fade{"100 ms", "1 ms", "10 s", "fade time of the force on the hand after seating"};

    void prepare(const Setup& setup) {
        parts_.reset();
        seat_ = {};
        if (task->guide_body) {
            try {
                parts_ = parts_of(*task->guide_body, spacing, false);
            } catch (const Error& error) {
                setup.fail(error.message());
            }
            seat_ = parts_->home;
        }
        has_grip_ = false;
        strength_ = parts_ ? 1.0 : 0.0;
        seated_ = !parts_;
        near_s_ = 0.0, time_ = 0.0, seated_at_ = 0.0;
        at_ = start();
        publish();
    }

    void process(const Tick& tick) noexcept {
        const double dt = tick.elapsed_seconds();
        time_ += dt;
        if (parts_ && !seated_) {
            const bool is_known = place.get() >= 0.0;
            // The coupling has no pose of the guide before the hand holds it.
            if (has_grip_ && is_known && is_valid(moved.get())) at_ = moved.get();
            // Not the first sample of the hand: it may be what a wire between groups brings before any value.
            if (!has_grip_ && is_known && is_valid(hand.get())) {
                grip_ = Pose{hand->position, glm::normalize(hand->orientation)}.inverse() * at_;
                has_grip_ = true;
            }
            const bool is_there = has_grip_ && away() < tolerance && turned() < angle_tolerance;
            near_s_ = is_there ? near_s_ + dt : 0.0;
            if (is_there && near_s_ >= dwell) {
                seated_ = true;
                seated_at_ = time_;
            }
        }
        if (seated_) strength_ = std::max(0.0, strength_ - dt / fade);
        publish();
    }

    void report(Report& report) const {
        if (!parts_) return;
        report.set("guide", "seated", seated_ ? 1.0 : 0.0);
        report.set("guide", "seated_at_s", seated_at_);
        report.set("guide", "distance_mm", away() / mm);
        report.set("guide", "angle_deg", turned() / degree);
    }

private:
    Pose start() const noexcept {
        if (!parts_) return {};
        return {seat_.position + lift.value * task->guide->removal, seat_.orientation};
    }
    double away() const noexcept { return glm::length(at_.position - seat_.position); }
    double turned() const noexcept { return glm::length(rotation_between(seat_.orientation, at_.orientation)); }

    void publish() noexcept {
        if (parts_) body = parts_->body();
        pose = at_;
        grip = grip_;
        target = seat_;
        near = parts_ && !seated_ && away() < reach && turned() < reach_angle;
        holding = parts_ && !seated_ && has_grip_;
        strength = strength_;
        held = parts_ && (!seated_ || strength_ > 0.0) ? 1.0 : -1.0;
        seated = seated_;
        offset = seated_ && parts_ ? at_ * seat_.inverse() : Pose{};
        distance = parts_ ? away() : 0.0;
        angle = parts_ ? turned() : 0.0;
    }

    std::shared_ptr<const BodyParts> parts_;
    Pose seat_, at_, grip_;
    bool has_grip_ = false, seated_ = false;
    double strength_ = 0.0, near_s_ = 0.0, time_ = 0.0, seated_at_ = 0.0;  // share, s
};

TACTUS_NODE(GuideSeat, hand, moved, place, body, pose, held, grip, target, near, holding, strength, seated, offset,
            distance, angle, task, lift, spacing, reach, reach_angle, tolerance, angle_tolerance, dwell, fade)

}  // namespace tactus::nodes
