// SPDX-License-Identifier: Apache-2.0
// Looking at the world through a screen that stands somewhere in it: what is drawn on the screen lies where the eye would
// see it (generalised perspective, Kooima 2008). The world here is that of the viewer, m.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/display/camera.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tactus::display {

/// A flat screen by three of its corners, as seen from its front.
struct Screen {
    Vec3 low_left{0.0}, low_right{0.0}, high_left{0.0};
    bool in_mirror = true;  ///< it is looked at in the mirror of its rig, where there is one

    Vec3 right() const { return low_right - low_left; }  ///< along the lower edge, its length
    Vec3 up() const { return high_left - low_left; }
    Vec3 normal() const;  ///< unit, towards who looks at it
};

/// How two eyes share one picture. `quad_buffer`: a buffer for each, where the graphics driver has two.
enum class StereoMode : std::uint8_t { mono, side_by_side, anaglyph, quad_buffer };
inline constexpr std::array<std::string_view, 4> stereo_names{"mono", "side-by-side", "anaglyph", "quad-buffer"};
std::optional<StereoMode> stereo_of_name(std::string_view name);

/// How a picture has to lie on its screen to be seen upright in a mirror.
enum class Flip : std::uint8_t { none, left_right, upside_down };

/// A plane; of a mirror either side may be the shiny one.
struct Plane {
    Vec3 point{0.0}, normal{0.0, 0.0, 1.0};  ///< normal of unit length

    Vec3 reflected(const Vec3& position) const;
    double height(const Vec3& position) const;  ///< above the plane, along the normal
    Mat4 reflection() const;
};

/// What the screen has to show to an eye at `eye`. Depth covers `scene`. Throws Error for a screen without area or with
/// edges that are not square within 1°, and for an eye that is not in front of it.
Projection through_screen(const Screen& screen, const Vec3& eye, const Bounds& scene);

/// The same when the eye sees the screen in a half-transparent mirror: the world seems to stand behind the mirror, and
/// the screen shows its reflection.
Projection through_mirror(const Screen& screen, const Plane& mirror, const Vec3& eye, const Bounds& scene);

/// Two eyes of a head: its x axis leads from the left one to the right one, `between` m apart.
struct Eyes {
    Vec3 left{0.0}, right{0.0};
};
Eyes eyes_of(const Pose& head, double between);

/// One picture of a rig.
struct RigView {
    std::size_t screen = 0;
    Vec3 eye{0.0};
    Projection projection;
};

/// Screens that show one world together. How the haptic world lies in that of the viewer decides whether things are
/// seen where they are felt.
struct DisplayRig {
    std::vector<Screen> screens;
    std::optional<Plane> mirror;
    double between_eyes = 0.063;  ///< m
    Pose haptic_world;  ///< of the simulation, in the world of the viewer
    Mat3 haptic_stretch{1.0};  ///< before that: a scaled workspace, or a device that calibration found not to be true
    /// What is seen is moved by so much against where it is felt, viewer's axes. 0: co-located; the study of the thesis
    /// moved it by 0.30 m along one axis (6.4.1).
    Vec3 visuo_haptic_offset{0.0};

    /// Left and right eye on every screen (`stereo`), else one in the middle. `scene` in the world of the simulation,
    /// from which the projections go. Throws Error as through_screen does.
    std::vector<RigView> views(const Pose& head, bool stereo, const Bounds& scene) const;
    /// One picture for each eye on each screen of a display with many fixed points of view, such as one projector per
    /// direction.
    std::vector<RigView> views(const std::vector<Vec3>& eyes, const Bounds& scene) const;
    /// What one eye sees on one screen.
    RigView view(std::size_t screen, const Vec3& eye, const Bounds& scene) const;

    bool is_mirrored(std::size_t screen) const { return mirror && screens[screen].in_mirror; }
    /// A head that looks straight at the middle of a screen, or of its image in the mirror, from `away` m. Up is z, or y
    /// where an image lies flat.
    Pose place_before(std::size_t screen, double away) const;
    /// From the world of the simulation to where its things are seen, in the world of the viewer.
    Mat4 seen_world() const;
};

}  // namespace tactus::display
