// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/saw_blade.hpp"
#include "dsp/saw/guide_slot.hpp"
#include "graph/node/node.hpp"
#include "graph/node/notice.hpp"
#include "graph/node/task_asset.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/tool_parameters.hpp"
#include "nodes/contact/tool_report.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

namespace tactus::nodes {

struct SawBlade {
    static constexpr auto about =
        "A saw blade that rests on the bone it has not cut yet: forces on all of its body, and a front of teeth, which "
        "a running saw advances by a cutting law per tooth (James 2013). 'carve' removes what the front passes. No "
        "push "
        "frees it: it is released by 'release', by a pause or a jump of the hand, and after 2 s at its greatest force "
        "with the hand outside of the bone.";

    In<Pose> pose{"of the blade: x along the teeth, y into the bone, origin in the middle of the tooth line"};
    In<volume::BoneSnapshot> bone{"the carved bone"};
    In<bool> running{optional, "the saw runs; unconnected: always"};
    In<double> strokes{optional, "cycles of the stroke per second; unconnected: 'stroke_rate'", "Hz"};
    In<bool> seated{optional, "the guide is on the bone: until then the blade has no force; unconnected: true"};
    In<Pose> guide_offset{optional, "of the seated guide from its plan: guide_seat.offset; unconnected: none", "m"};
    In<bool> release{optional, "while held, the bone is released: wire the clutch of the hand here"};
    In<Wrench> asked{optional,
                     "what device_output was asked for, as delay 1; with 'applied' teeth cut by the share of "
                     "their thrust that the hand could feel",
                     "N, N m"};
    In<Wrench> applied{optional, "what the device was given, device_output.applied as delay 1", "N, N m"};
    Out<Wrench> wrench{"on the blade, about its origin", "N, N m"};
    Out<Pose> held{
        "pose of the blade: 'pose', moved as far as a slot of the guide requires; 0.1 m back until the guide "
        "is seated and the blade free",
        "m"};
    Out<double> slot{"of the guide that holds the blade: 1 for the first; 0: none"};
    Out<double> load{"thrust against the cutting direction", "N"};
    Out<double> stroke_force{"of the teeth along the stroke, to and fro at the stroke's rate", "N"};
    Out<double> feed{"advance of the teeth that cut", "m/s"};
    Out<double> teeth{"teeth that bear on bone", "1"};
    Out<double> passing{
        "teeth that pass a place at mid-stroke: speed of the teeth over their pitch; 0 while the saw "
        "stands",
        "Hz"};
    Out<double> penetration{"greatest elastic distance of a point of the blade from where bone holds it", "m"};
    Out<bool> in_contact{"the force between blade and bone passed 'contact_on' and has not fallen below 'contact_off'"};
    Out<bool> waiting{"the blade lies in bone and has no force until it is out"};
    Out<double> rendered{"share of the wanted force that the device was given in the last tick", "1"};
    Out<carve::CutFront> front{"how far the teeth have cut; wire it to carve.front as batch"};
    static constexpr double max_felt_stiffness = 40e3;  // N/m
    Param stiffness{structural, "0.8 N/mm", "0.01 N/mm", "40 N/mm",
                    "upper bound of the stiffness that the hand feels, for any number of points in contact; times "
                    "'device_scale' at most 40 N/mm"};
    Asset<training::Task> guide{optional,
                                "task whose guide stops the blade (the guide is never cut) and whose slots hold it"};
    Param guide_stiffness{structural, "10 N/mm", "0.01 N/mm", "40 N/mm",
                          "of the hand's spring against the walls of a slot; the blade itself never leaves the slot"};
    Param device_scale{
        "1", "0.01", "10",
        "forces on the device over those of the tool; teeth cut by those of the tool, so that devices of "
        "different strength are comparable"};
    ContactThreshold threshold;
    Param stroke_rate{"228 Hz", "1 Hz", "1000 Hz", "cycles of the stroke per second, unless 'strokes' is connected"};
    Param sharpness{structural, "1", "0.1", "20",
                    "forces of the published teeth over those of these: the same thrust cuts that much more"};
    Flag sagittal{false,
                  "the blade swings about an axis 'height' behind its teeth, which stand on an arc about it; otherwise "
                  "it strokes along its length"};
    Param length{structural, "40 mm", "5 mm", "80 mm", "of the tooth line"};
    Param height{structural, "10 mm", "1 mm", "100 mm", "of the blade, from the teeth back"};
    Param thickness{structural, "0.7 mm", "0.1 mm", "5 mm", "of the blade; the kerf is a little wider"};
    Param kerf{structural, "1 mm", "0.1 mm", "5 mm", "width of the cut, that of the set teeth; as in carve"};
    Param stroke{structural, "3 mm", "1.5 mm", "8 mm", "of the teeth, peak to peak"};
    Param tooth_pitch{structural, "1.411 mm", "0.5 mm", "4 mm", "from tooth to tooth: 18 per inch"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::blade,
                 .pose = "held",
                 .force = "wrench",
                 .size = {length.value, height.value, thickness.value}}};
    }

    void prepare(const Setup& setup) {
        // Teeth resolve 0.15 of a voxel (0.08 mm at 0.5 mm): on a stiffer tool the force would step by over 3 N.
        for (const auto& [name, given] : {std::pair{"stiffness", &stiffness}, {"guide_stiffness", &guide_stiffness}})
            if ((given == &stiffness || guide) && *given * device_scale > max_felt_stiffness)
                setup.fail(fmt::format(
                    "'{}' times 'device_scale' is {:.3g} N/mm; above {:.3g} N/mm the voxels of the bone are felt "
                    "as steps",
                    name, *given * device_scale * 1e-3, max_felt_stiffness * 1e-3));
        saw::SawShape shape;
        shape.kind = sagittal ? saw::SawKind::sagittal : saw::SawKind::reciprocating;
        shape.length = length;
        shape.height = height;
        shape.thickness = thickness;
        shape.kerf = kerf;
        shape.stroke = stroke;
        shape.pitch = tooth_pitch;
        if (shape.stroke < shape.pitch)
            setup.fail(
                fmt::format("a stroke of {:.3g} mm is shorter than the tooth pitch of {:.3g} mm and would leave "
                            "ridges; lengthen the stroke",
                            stroke * 1e3, tooth_pitch * 1e3));
        if ((shape.length + shape.stroke) / shape.pitch > carve::CutFront::max_nodes - 1)
            setup.fail(fmt::format("{:.3g} mm of teeth {:.3g} mm apart are more than {}; shorten the blade",
                                   (shape.length + shape.stroke) * 1e3, shape.pitch * 1e3,
                                   carve::CutFront::max_nodes - 1));
        if (shape.kerf <= shape.thickness)
            setup.fail("the kerf is not wider than the blade, which would bind; widen 'kerf' or thin the blade");
        if (shape.kind == saw::SawKind::sagittal && shape.height < 0.5 * (shape.length + shape.stroke) * 1.1)
            setup.fail(fmt::format(
                "a sagittal blade swings about an axis {:.3g} mm behind its teeth, too near for {:.3g} mm of "
                "teeth and their stroke; lengthen 'height'",
                shape.height * 1e3, shape.length * 1e3));
        max_scale_ = max_felt_stiffness / (guide ? std::max<double>(stiffness, guide_stiffness) : stiffness);
        law_ = saw::CuttingLaw{}.with_edge(kerf).sharpened(sharpness);
        blade_.emplace(shape, stiffness);
        hold_ = saw::SlotHold(shape, {.stiffness = guide_stiffness, .thickness = kerf});
        guide_body_.reset();
        if (guide && guide->guide_body) {
            const bone::Bone& body = *guide->guide_body;
            guide_body_ = std::make_unique<volume::BoneEditor>(
                body.distance, body.density, volume::BoneEditorOptions{.max_dirty = 1, .max_versions = 1});
            guide_now_ = guide_body_->current();
            guide_solid_ = {.solid = &guide_now_, .pose = {}};
            is_guide_placed_ = false;
            if (guide_offset.connected && !seated.connected)
                setup.fail("'guide_offset' is that of a seated guide; connect guide_seat.seated to 'seated', too");
        }
        held = Pose{};
        waits_.attach(setup);
        released_.attach(setup);
        last_state_ = saw::HoldState::engaged;
        last_pose_ = {};
        is_in_hand_ = !guide_body_ || !seated.connected;
        max_guide_force_ = 0.0;
        touch_ = {};
        pause_ = {};
        told_ = {};
        last_ = {};
    }

    void process(const Tick& tick) noexcept {
        const saw::Drive drive{
            .running = !running.connected || running.get(),
            .rate = strokes.connected ? std::clamp(strokes.get(), 0.0, 2000.0) : static_cast<double>(stroke_rate),
            .dt = step_of(tick),
            .rendered = rendered_share(asked, applied),
            .release =
                pause_.is_moved_in_pause(tick, pose.get()) || (release.connected && release.get()) || !is_seated()};
        place_guide();
        const Pose at = guided(drive);
        const saw::SawContact now = blade_->step(bone.get(), at, drive, law_, guide_body_ ? &guide_solid_ : nullptr);
        // 'device_scale' can be changed while the patch runs.
        wrench = on_hand(now.wrench) * std::min<double>(device_scale, max_scale_);
        // While the hand holds the guide it holds no saw, so the blade injures nothing.
        is_in_hand_ = is_in_hand_ || (is_seated() && now.state == saw::HoldState::engaged);
        held = is_in_hand_ ? at : Pose{at.position - at.rotate(Vec3(0.0, laid_aside, 0.0)), at.orientation};
        slot = hold_.slot() + 1;
        load = now.thrust;
        stroke_force = now.along;
        feed = now.feed;
        teeth = now.teeth;
        passing = drive.running ? std::numbers::pi * drive.rate * stroke / tooth_pitch : 0.0;
        penetration = now.lag;
        const bool touches = threshold.update(touch_, now.magnitudes);
        in_contact = touches;
        waiting = now.state == saw::HoldState::waiting;
        rendered = drive.rendered;
        blade_->teeth().fill(last_, at, drive.running && now.state == saw::HoldState::engaged);
        ++last_.version;
        last_.content_hash = carve::hash_of(last_);
        front = last_;
        if (now.state != last_state_ && is_valid(pose.get())) {
            if (now.state == saw::HoldState::waiting) waits_.tell();
            if (now.state == saw::HoldState::releasing && now.count > 0) released_.tell();
            last_state_ = now.state;
        }
        told_.add(bone.get(), pose.get(), {now.state, touches, now.thrust, now.lag, drive.rendered, 0.0, drive.dt});
    }

    void report(Report& report) const {
        told_.tell(report, device_scale);
        if (guide_body_) report.set("guide", "max_force_N", max_guide_force_);
    }

private:
    bool is_seated() const noexcept { return !guide_body_ || !seated.connected || seated.get(); }

    /// A blade that waits to be drawn out of bone, or is released, is in no slot, either.
    Pose guided(const saw::Drive& drive) noexcept {
        if (!guide_body_) return pose.get();
        const bool is_lost = !is_valid(pose.get()) || glm::length(pose->position) > 1e3 ||
                             saw::is_jump(last_pose_, pose.get(), 0.5 * length + height, drive.dt);
        last_pose_ = pose.get();
        if (is_lost) {
            hold_.drop();
            return pose.get();
        }
        const bool is_held = is_seated() && !drive.release && last_state_ == saw::HoldState::engaged;
        const Pose at =
            hold_.follow(is_held ? std::span<const saw::GuideSlot>(guide->slots) : std::span<const saw::GuideSlot>(),
                         guide_solid_.back * pose.get(), drive.dt);
        max_guide_force_ = std::max(max_guide_force_, hold_.force());
        return guide_solid_.pose * at;
    }

    /// A guide lies where it was when it was seated: walls that moved later would push the blade at once.
    void place_guide() noexcept {
        if (!guide_offset.connected) return;
        if (!is_seated()) is_guide_placed_ = false;
        else if (!is_guide_placed_ && is_valid(guide_offset.get())) {
            is_guide_placed_ = true;
            guide_solid_ = {.solid = &guide_now_,
                            .pose = {guide_offset->position, glm::normalize(guide_offset->orientation)}};
        }
    }

    Wrench on_hand(const Wrench& on_blade) const noexcept {
        if (!guide_body_) return on_blade;
        const Pose &to = guide_solid_.pose, &back = guide_solid_.back;
        const Wrench w = hold_.on_hand({back.rotate(on_blade.force), back.rotate(on_blade.torque)});
        return {to.rotate(w.force), to.rotate(w.torque)};
    }

    std::optional<saw::SawBlade> blade_;
    saw::CuttingLaw law_;
    carve::CutFront last_;
    ToolReport told_;
    contact::ContactSwitch touch_;
    PauseWatch pause_;
    saw::SlotHold hold_;
    std::unique_ptr<volume::BoneEditor> guide_body_;  // never edited
    volume::BoneSnapshot guide_now_;
    saw::PlacedSolid guide_solid_;
    static constexpr double laid_aside = 0.1;  // m
    Pose last_pose_;
    bool is_in_hand_ = true, is_guide_placed_ = false;
    double max_guide_force_ = 0.0, max_scale_ = 1.0;
    Notice waits_{tool_waits}, released_{tool_released};
    saw::HoldState last_state_ = saw::HoldState::engaged;
};

TACTUS_NODE(SawBlade, pose, bone, running, strokes, seated, guide_offset, release, asked, applied, wrench, held, slot,
            load, stroke_force, feed, teeth, passing, penetration, in_contact, waiting, rendered, front, stiffness,
            guide, guide_stiffness, device_scale, threshold, stroke_rate, sharpness, sagittal, length, height,
            thickness, kerf, stroke, tooth_pitch)
TACTUS_VISUALS(SawBlade)

}  // namespace tactus::nodes
