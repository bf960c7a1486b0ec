// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/burr.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/tool_report.hpp"

#include <algorithm>
#include <optional>

namespace tactus::nodes {

struct Burr {
    static constexpr auto about =
        "A round burr that rests on the bone it has not cut yet and, running, advances along its own force by the "
        "cutting "
        "law of saw_blade. 'carve' removes what it passes.";

    In<Pose> pose{"of the tool: origin in the middle of the ball"};
    In<volume::BoneSnapshot> bone{"the carved bone"};
    In<bool> running{optional, "the burr turns; unconnected: always"};
    Out<Wrench> wrench{"on the tool, about the middle of the ball", "N, N m"};
    Out<double> load{"force between burr and bone", "N"};
    Out<double> flute_force{"of the flutes, around the shaft", "N"};
    Out<double> feed{"advance of the burr in bone", "m/s"};
    Out<double> penetration{"elastic distance of the ball from where bone holds it", "m"};
    Out<bool> in_contact{"the ball touches bone"};
    Out<carve::CutFront> front{"where the ball has cut; wire it to carve.front as batch"};
    Param stiffness{structural, "0.8 N/mm", "0.01 N/mm", "50 N/mm", "that the hand feels"};
    Param diameter{structural, "4 mm", "1 mm", "8 mm", "of the ball; also the 'kerf' of carve"};
    Param flutes{structural, "8", "1", "32", "cutting edges; one bears at a time"};
    Param turn_rate{"1000 Hz", "1 Hz", "2000 Hz", "turns per second"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::ball, .pose = "pose", .force = "wrench", .radius = 0.5 * diameter}};
    }

    void prepare(const Setup&) {
        burr_.emplace(saw::BurrShape{0.5 * diameter, flutes}, stiffness);
        told_ = {};
        last_ = {};
    }

    void process(const Tick& tick) noexcept {
        const bool runs = !running.connected || running.get();
        const double dt = std::clamp(tick.elapsed_seconds(), seconds(tick.period), 0.05);
        const saw::BurrContact now = burr_->step(bone.get(), pose.get(), runs, turn_rate, dt, law_);
        wrench = now.wrench;
        load = now.load;
        flute_force = now.along;
        feed = now.feed;
        penetration = now.lag;
        in_contact = now.touches;
        burr_->fill(last_, pose.get(), runs);
        ++last_.version;
        last_.content_hash = carve::hash_of(last_);
        front = last_;
        told_.add(bone.get(), pose.get(), now.touches, now.load, now.lag, 0.5 * diameter);
    }

    void report(Report& report) const { told_.tell(report); }

private:
    std::optional<saw::Burr> burr_;
    saw::CuttingLaw law_;
    carve::CutFront last_;
    ToolReport told_;
};

TACTUS_NODE(Burr, pose, bone, running, wrench, load, flute_force, feed, penetration, in_contact, front, stiffness,
            diameter, flutes, turn_rate)
TACTUS_VISUALS(Burr)

}  // namespace tactus::nodes
