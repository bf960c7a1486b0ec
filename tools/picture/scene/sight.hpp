// SPDX-License-Identifier: Apache-2.0
// Through which eyes a scene is seen on which screen: a camera's, or those of a head before the screens of a rig.
#pragma once

#include "assets/display/rig_file.hpp"
#include "devices/display/legend.hpp"
#include "devices/display/scene_renderer.hpp"
#include "engine/observe/observer.hpp"
#include "tools/picture/scene/scene_outline.hpp"
#include "tools/picture/scene/sight_choice.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::picture {

/// Throws Error listing the names there are.
display::StereoMode parse_stereo(const std::string& text);
/// "none", "study": the thesis's 0.3 m, here to the viewer's right, or three lengths. Throws Error.
Vec3 parse_offset(const std::string& text);

class Sight {
public:
    /// Reads the rig. Throws Error.
    explicit Sight(const SightChoice& choice);

    display::StereoMode stereo = display::StereoMode::mono;
    std::string head;  ///< output that is the head; empty: none

    /// Reads another rig, or none for an empty path. Throws Error, and all stays as it was.
    void use_rig(const std::filesystem::path& path);
    const std::optional<display::RigFile>& rig() const { return rig_; }
    /// Moves what is seen against what is felt, m, viewer's axes; of a rig only.
    void set_offset(const Vec3& offset);

    /// Learns from the outline which outputs say how the device stands in the scene.
    void follow(const SceneOutline& outline);
    /// Outputs that it needs to see.
    std::vector<std::string> ports() const;
    /// Where head and device are now. What does not come as a whole, or is no pose, stays as it was.
    void update(const observe::Observer& observer);

    /// Without a rig: one.
    std::size_t screens() const { return rig_ ? rig_->screens.size() : 1; }
    display::StereoMode mode_of(std::size_t screen) const;
    /// Width over height of what one eye sees on it; none without a rig.
    std::optional<double> aspect_of(std::size_t screen) const;
    /// A head or a rig decides what is seen, not the camera alone.
    bool is_off_axis() const { return rig_ || !head.empty(); }

    /// What is to be drawn into a picture that fills the screen. While the head is where it cannot see a screen, the
    /// picture before stays, and `warnings` says so.
    std::vector<display::DrawnView> views(std::size_t screen, const display::OrbitCamera& camera,
                                          const display::Bounds& scene, int width, int height);
    const std::vector<std::string>& warnings() const { return warnings_; }
    /// The head of the last `update`, in the world of the viewer; none: nothing tells where it is.
    const std::optional<Pose>& head_pose() const { return head_pose_; }

    /// How a picture's text has to lie for who sees it in a mirror.
    display::Flip text_of(std::size_t screen) const;

private:
    /// With the device where it is now.
    display::DisplayRig rig_now() const;
    std::vector<Vec3> eyes_for(std::size_t screen, const display::DisplayRig& rig) const;

    std::optional<display::RigFile> rig_;
    std::optional<Vec3> offset_;
    std::optional<SceneOutline::Place> place_;
    std::optional<Pose> head_pose_;
    Mat3 to_device_{1.0};  // from the scene to the device's frame
    Vec3 shift_to_device_{0.0};
    std::vector<std::vector<display::RigView>> last_;
    std::vector<std::string> warnings_;
};

/// The legend in every view of a picture, at one place for both eyes: on the screen itself.
void add_legend(display::Image& image, const display::Legend& legend, std::span<const display::DrawnView> views,
                display::Flip flip);

}  // namespace tactus::picture
