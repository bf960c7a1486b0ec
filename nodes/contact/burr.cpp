// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/burr.hpp"
#include "graph/node/node.hpp"
#include "graph/node/notice.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/tool_parameters.hpp"
#include "nodes/contact/tool_report.hpp"

#include <algorithm>
#include <optional>

namespace tactus::nodes {

struct Burr {
    static constexpr auto about =
        "A round burr that rests on the bone it has not cut yet and, running, advances along its own force by the "
        "cutting law of saw_blade, with the force per width of the flute in bone. Its shaft does not cut. 'carve' "
        "removes what the ball passes. No push frees it: it "
        "is released by 'release', by a pause or a jump of the hand, and after 2 s at its greatest force with the hand "
        "outside of the bone.";

    In<Pose> pose{"of the tool: origin in the middle of the ball"};
    In<volume::BoneSnapshot> bone{"the carved bone"};
    In<bool> running{optional, "the burr turns; unconnected: always"};
    In<bool> release{optional, "while held, the bone is released: wire the clutch of the hand here"};
    In<Wrench> asked{optional,
                     "what device_output was asked for, as delay 1; with 'applied' the burr cuts by the share "
                     "of its force that the hand could feel",
                     "N, N m"};
    In<Wrench> applied{optional, "what the device was given, device_output.applied as delay 1", "N, N m"};
    Out<Wrench> wrench{"on the tool, about the middle of the ball", "N, N m"};
    Out<double> load{"force between burr and bone", "N"};
    Out<double> flute_force{"of the flutes, around the shaft", "N"};
    Out<double> feed{"advance of the burr in bone", "m/s"};
    Out<double> penetration{"elastic distance of the ball from where bone holds it", "m"};
    Out<bool> in_contact{"the force between burr and bone passed 'contact_on' and has not fallen below 'contact_off'"};
    Out<bool> waiting{"the burr lies in bone and has no force until it is out"};
    Out<double> rendered{"share of the wanted force that the device was given in the last tick", "1"};
    Out<carve::CutFront> front{"where the ball has cut; wire it to carve.front as batch"};
    Param stiffness{structural, "0.8 N/mm", "0.01 N/mm", "50 N/mm", "that the hand feels"};
    Param device_scale{
        "1", "0.01", "10",
        "forces on the device over those of the tool; the burr cuts by those of the tool, so that devices "
        "of different strength are comparable"};
    ContactThreshold threshold;
    Param diameter{structural, "4 mm", "1 mm", "8 mm", "of the ball; also the 'kerf' of carve"};
    Param flutes{structural, "8", "1", "32", "cutting edges; one bears at a time"};
    Param sharpness{structural, "1", "0.1", "20",
                    "forces of the published teeth over those of these flutes: the same force cuts that much more"};
    Param shaft_diameter{structural, "2.35 mm", "0 mm", "8 mm",
                         "of the shaft behind the ball, as ISO 1797-1, and at most 0.6 of the ball's; 0: none"};
    Param shaft_length{structural, "25 mm", "1 mm", "150 mm", "from the ball to the handpiece"};
    Param turn_rate{"1000 Hz", "1 Hz", "2000 Hz", "turns per second"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::ball, .pose = "pose", .force = "wrench", .radius = 0.5 * diameter}};
    }

    void prepare(const Setup& setup) {
        // Behind a small ball the shaft has a neck.
        law_ = saw::CuttingLaw{}.sharpened(sharpness);
        const double shaft = std::min<double>(shaft_diameter, 0.6 * diameter);
        burr_.emplace(saw::BurrShape{0.5 * diameter, flutes, 0.5 * shaft, shaft_length}, stiffness);
        waits_.attach(setup);
        released_.attach(setup);
        last_state_ = saw::HoldState::engaged;
        touch_ = {};
        pause_ = {};
        told_ = {};
        last_ = {};
    }

    void process(const Tick& tick) noexcept {
        const saw::Drive drive{
            .running = !running.connected || running.get(),
            .rate = turn_rate,
            .dt = step_of(tick),
            .rendered = rendered_share(asked, applied),
            .release = pause_.is_moved_in_pause(tick, pose.get()) || (release.connected && release.get())};
        const saw::BurrContact now = burr_->step(bone.get(), pose.get(), drive, law_);
        wrench = now.wrench * device_scale;
        load = now.load;
        flute_force = now.along;
        feed = now.feed;
        penetration = now.lag;
        const bool touches = threshold.update(touch_, now.magnitudes);
        in_contact = touches;
        waiting = now.state == saw::HoldState::waiting;
        rendered = drive.rendered;
        burr_->fill(last_, pose.get(), drive.running && now.state == saw::HoldState::engaged);
        ++last_.version;
        last_.content_hash = carve::hash_of(last_);
        front = last_;
        if (now.state != last_state_ && is_valid(pose.get())) {
            if (now.state == saw::HoldState::waiting) waits_.tell();
            if (now.state == saw::HoldState::releasing && now.touches) released_.tell();
            last_state_ = now.state;
        }
        told_.add(bone.get(), pose.get(),
                  {now.state, touches, now.load, now.lag, drive.rendered, 0.5 * diameter, drive.dt});
    }

    void report(Report& report) const { told_.tell(report, device_scale); }

private:
    std::optional<saw::Burr> burr_;
    saw::CuttingLaw law_;
    carve::CutFront last_;
    ToolReport told_;
    contact::ContactSwitch touch_;
    PauseWatch pause_;
    Notice waits_{tool_waits}, released_{tool_released};
    saw::HoldState last_state_ = saw::HoldState::engaged;
};

TACTUS_NODE(Burr, pose, bone, running, release, asked, applied, wrench, load, flute_force, feed, penetration,
            in_contact, waiting, rendered, front, stiffness, device_scale, threshold, diameter, flutes, sharpness,
            shaft_diameter, shaft_length, turn_rate)
TACTUS_VISUALS(Burr)

}  // namespace tactus::nodes
