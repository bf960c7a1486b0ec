// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/placement.hpp"
#include "dsp/volume/site.hpp"
#include "graph/assets.hpp"
#include "graph/node.hpp"

#include <optional>

namespace tactus::nodes {

struct Workspace {
    static constexpr auto about =
        "Places the device in the scene and the tool in the hand. Given a bone, it finds a place where a saw blade can "
        "be "
        "set on, and puts the resting tool in front of it. Forces go back through device_wrench.";

    In<Pose> device{"handle in the device frame", "m"};
    Out<Pose> pose{"tool in the scene", "m"};
    Out<Pose> frame{"the device's axes, at the handle, in the scene; for device_wrench", "m"};
    Out<double> force_scale{"the scale, for device_wrench", "1"};
    Asset<Bone> bone{optional,
                     "what is to be cut; origin and rotation then count from the tool's place in front of it"};
    Vector origin{"0 mm, 0 mm, 0 mm", "of the device frame in the scene"};
    Vector rotation{"0 deg, 0 deg, 0 deg", "of the device frame in the scene: about x first, then y, then z"};
    Param scale{structural, "1", "0.01", "100", "distance in the scene per distance of the device"};
    Vector grip{"0 mm, 0 mm, 0 mm", "origin of the tool in the frame of the handle"};
    Vector grip_rotation{
        "-90 deg, 0 deg, 0 deg",
        "of the tool in the frame of the handle: about x first, then y, then z; by default a blade cuts "
        "towards -z of the device"};
    Param clearance{structural, "5 mm", "0 mm", "100 mm", "from the resting tool to the bone"};

    void prepare(const Setup& setup) {
        placement_ = {{origin, rotation_xyz(rotation)}, scale, {grip, rotation_xyz(grip_rotation)}};
        if (bone) placement_.device = in_front_of(*bone, setup) * placement_.device;
        place({});
    }
    void process(const Tick&) noexcept { place(device); }

    void report(Report& report) const {
        if (!site_) return;
        const auto list = [](const Vec3& v) { return std::vector<double>{v.x, v.y, v.z}; };
        report.set("site", "position_mm", list(site_->point * 1e3));
        report.set("site", "normal", list(-site_->feed));
        report.set("site", "stroke", list(site_->stroke));
        report.set("site", "thickness_mm", site_->thickness * 1e3);
        report.set("site", "width_mm", site_->width * 1e3);
    }

private:
    void place(const Pose& handle) noexcept {
        pose = placement_.tool(handle);
        frame = placement_.frame(handle);
        force_scale = placement_.scale;
    }

    /// Frame of the device so that a handle at its origin holds the tool in front of the site: x of the tool along the
    /// stroke, y into the bone.
    Pose in_front_of(const Bone& target, const Setup& setup) {
        site_ = find_saw_site(target.distance, target.density);
        if (!site_)
            setup.fail("no place was found on bone '" + bone.name +
                       "' where a saw blade can be set on; leave 'bone' out and give 'origin' and 'rotation'");
        const Mat3 axes(site_->stroke, site_->feed, glm::cross(site_->stroke, site_->feed));
        const Pose tool{site_->point - site_->feed * clearance.value, glm::normalize(glm::quat_cast(axes))};
        return tool * placement_.grip.inverse();
    }

    Placement placement_;
    std::optional<SawSite> site_;
};

TACTUS_NODE(Workspace, device, pose, frame, force_scale, bone, origin, rotation, scale, grip, grip_rotation, clearance)

}  // namespace tactus::nodes
