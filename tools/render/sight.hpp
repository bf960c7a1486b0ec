// SPDX-License-Identifier: Apache-2.0
// The views of a scene: from a camera, or from the eyes of a tracked head in front of the screens of a display.
#pragma once

#include "assets/display/display_file.hpp"
#include "devices/display/legend.hpp"
#include "devices/display/scene_renderer.hpp"
#include "engine/observe/observer.hpp"
#include "tools/render/scene_outline.hpp"
#include "tools/render/sight_choice.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::render {

/// Throws Error listing the valid names.
display::StereoMode parse_stereo(const std::string& text);
/// "none", "study" (0.3 m to the viewer's right, as in the study of Olsson 2015), or three lengths. Throws Error.
Vec3 parse_offset(const std::string& text);

class Sight {
public:
    /// Reads the display file. Throws Error.
    explicit Sight(const SightChoice& choice);

    display::StereoMode stereo = display::StereoMode::mono;
    std::string head;  ///< output with the head's pose; empty: none

    /// Reads another display file; an empty path: none. Throws Error and then changes nothing.
    void use_display(const std::filesystem::path& path);
    const std::optional<display::DisplayFile>& display_file() const { return file_; }
    /// Shifts the picture against the haptic position, m, viewer's axes; only with a display file.
    void set_offset(const Vec3& offset);

    /// Takes the outputs of the device's workspace from the outline.
    void follow(const SceneOutline& outline);
    /// Outputs that must be observed.
    std::vector<std::string> ports() const;
    /// Updates head and device. Incomplete or invalid poses are ignored.
    void update(const observe::Observer& observer);

    /// 1 without a display file.
    std::size_t screens() const { return file_ ? file_->screens.size() : 1; }
    display::StereoMode mode_of(std::size_t screen) const;
    /// Width over height of one eye's picture; none without a display file.
    std::optional<double> aspect_of(std::size_t screen) const;
    /// A head or a display file sets the projection, not the camera alone.
    bool is_off_axis() const { return file_ || !head.empty(); }

    /// The views for a picture that fills the screen. While the head cannot see a screen, the last views are kept and
    /// `warnings` says so.
    std::vector<display::DrawnView> views(std::size_t screen, const display::OrbitCamera& camera,
                                          const display::Bounds& scene, int width, int height);
    const std::vector<std::string>& warnings() const { return warnings_; }
    /// The head of the last `update`, in the world of the viewer; none: unknown.
    const std::optional<Pose>& head_pose() const { return head_pose_; }

    /// The flip of text for a picture seen in a mirror.
    display::Flip text_of(std::size_t screen) const;

private:
    /// The display geometry with the current pose of the device.
    display::DisplayGeometry geometry_now() const;
    std::vector<Vec3> eyes_for(std::size_t screen, const display::DisplayGeometry& geometry) const;

    std::optional<display::DisplayFile> file_;
    std::optional<Vec3> offset_;
    std::optional<SceneOutline::Place> place_;
    std::optional<Pose> head_pose_;
    Mat3 to_device_{1.0};  // from the scene to the device's frame
    Vec3 shift_to_device_{0.0};
    std::vector<std::vector<display::ScreenView>> last_;
    std::vector<std::string> warnings_;
};

/// Draws the legend into every view, at the same screen position for both eyes.
void add_legend(display::Image& image, const display::Legend& legend, std::span<const display::DrawnView> views,
                display::Flip flip);

}  // namespace tactus::render
