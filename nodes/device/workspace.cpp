// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/placement.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/site_parameters.hpp"

#include <glm/geometric.hpp>

#include <optional>

namespace tactus::nodes {

struct Workspace {
    static constexpr auto about =
        "Maps the device into the scene and the tool into the hand. With a bone, it finds a site for a saw cut and "
        "puts the resting tool in front of it. While 'clutch' is held, the hand moves and the tool stays; while 'turn' "
        "is held, the scene turns and shifts with the hand. Forces go back through device_wrench.";
    static constexpr NodeRole role = NodeRole::placement;

    In<Pose> device{"pose of the handle in the device frame", "m"};
    In<bool> clutch{optional, "held: the hand moves and the tool stays"};
    In<bool> turn{optional, "held: the scene turns and shifts with the hand"};
    Out<Pose> pose{"pose of the tool in the scene", "m"};
    Out<Pose> frame{"device axes at the handle, in the scene; for device_wrench", "m"};
    Out<double> force_scale{"the scale, for device_wrench", "1"};
    Asset<bone::Bone> bone{
        optional, "bone to cut; origin and rotation are then relative to the tool's resting place in front of it"};
    Vector origin{"0 mm, 0 mm, 0 mm", "of the device frame in the scene"};
    Vector rotation{"0 deg, 0 deg, 0 deg", "of the device frame in the scene: about x first, then y, then z"};
    Param scale{"1", "0.01", "100",
                "distance in the scene per distance of the device; the tool stays in place when it changes"};
    Vector grip{"0 mm, 0 mm, 0 mm", "origin of the tool in the frame of the handle"};
    Vector grip_rotation{
        "-90 deg, 0 deg, 0 deg",
        "of the tool in the frame of the handle: about x first, then y, then z; the default makes a blade cut towards "
        "-z of the device"};
    Flag find_site{true, find_site_about};
    Vector site{"0 mm, 0 mm, 0 mm", site_about};
    Vector approach{"0, 0, 0", approach_about};
    Vector along{"0, 0, 0", along_about};
    Param clearance{
        structural, "5 mm", "0 mm", "100 mm",
        "from the resting tool to the bone; more where a blade at that distance would lie in bone beside the site"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::workspace, .value = "force_scale", .hand = "device", .frame = "frame"},
                {.kind = VisualKind::handle, .pose = "pose"}};
    }

    void prepare(const Setup& setup) {
        placement_ = {{origin, coupling::rotation_xyz(rotation)}, scale, {grip, coupling::rotation_xyz(grip_rotation)}};
        holds_ = turns_ = false;
        last_ = {};
        if (bone) placement_.device = in_front_of(*bone, setup) * placement_.device;
        place({});
    }
    void process(const Tick&) noexcept {
        const Pose hand = device;
        // A faulty pose must not move what is to stay.
        if (is_valid(hand) && glm::length(hand.position) < farthest)
            arrange({hand.position, glm::normalize(hand.orientation)});
        place(hand);
    }

    void report(Report& report) const {
        if (!site_) return;
        const auto list = [](const Vec3& v) { return std::vector<double>{v.x, v.y, v.z}; };
        report.set("site", "position_mm", list(site_->point * 1e3));
        report.set("site", "normal", list(-site_->feed));
        report.set("site", "stroke", list(site_->stroke));
        report.set("site", "thickness_mm", site_->thickness * 1e3);
        report.set("site", "width_mm", site_->width * 1e3);
        report.set("site", "clearance_mm", away_ * 1e3);
    }

private:
    /// Moves the device frame in the scene for a button or a new scale, so that the tool stays in place.
    void arrange(const Pose& hand) noexcept {
        const bool holds = clutch.connected && clutch.get(), turns = turn.connected && turn.get();
        Pose& frame_in_scene = placement_.device;
        const Pose handle{frame_in_scene.apply(last_.position * placement_.scale),
                          frame_in_scene.orientation * last_.orientation};
        const bool keeps_turn = turns && turns_;
        if (scale != placement_.scale || (holds && holds_) || keeps_turn) {
            placement_.scale = scale;
            if (keeps_turn)
                frame_in_scene.orientation = glm::normalize(handle.orientation * glm::conjugate(hand.orientation));
            frame_in_scene.position = handle.position - frame_in_scene.orientation * (hand.position * placement_.scale);
        }
        holds_ = holds;
        turns_ = turns;
        last_ = hand;
    }

    void place(const Pose& handle) noexcept {
        pose = placement_.tool(handle);
        frame = placement_.frame(handle);
        force_scale = placement_.scale;
    }

    /// Frame of the device for which a handle at its origin holds the tool in front of the site: the tool's x along the
    /// stroke, y into the bone.
    Pose in_front_of(const bone::Bone& target, const Setup& setup) {
        site_ = site_of(target, find_site, site, approach, along, setup);
        if (!site_)
            setup.fail(find_site ? "found no site for a saw cut on bone '" + bone.name +
                                       "'; choose one by --site X,Y,Z (mm), or leave 'bone' out and set 'origin' and "
                                       "'rotation'"
                                 : "bone '" + bone.name + "' has no surface near 'site'; give a point on or above it");
        const Mat3 axes(site_->stroke, site_->feed, glm::cross(site_->stroke, site_->feed));
        away_ = volume::resting_clearance(target.distance, *site_, clearance);
        const Pose tool{site_->point - site_->feed * away_, glm::normalize(glm::quat_cast(axes))};
        return tool * placement_.grip.inverse();
    }

    static constexpr double farthest = 1e3;  // m

    coupling::Placement placement_;
    Pose last_;
    bool holds_ = false, turns_ = false;
    std::optional<volume::SawSite> site_;
    double away_ = 0.0;  // m from the resting tool to the site
};

TACTUS_NODE(Workspace, device, clutch, turn, pose, frame, force_scale, bone, origin, rotation, scale, grip,
            grip_rotation, find_site, site, approach, along, clearance)
TACTUS_VISUALS(Workspace)

}  // namespace tactus::nodes
