// SPDX-License-Identifier: Apache-2.0
// Off-axis projection through screens placed in the world: objects appear where the eye would see them (generalised
// perspective projection, Kooima 2008). The world here is that of the viewer, m.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/display/camera.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tactus::display {

/// A flat screen, by three of its corners as seen from its front.
struct Screen {
    Vec3 low_left{0.0}, low_right{0.0}, high_left{0.0};
    bool in_mirror = true;  ///< seen in the mirror, if the display has one

    Vec3 right() const { return low_right - low_left; }  ///< along the lower edge, its length
    Vec3 up() const { return high_left - low_left; }
    Vec3 normal() const;  ///< unit, towards the viewer
};

/// Stereo format. `quad_buffer`: one buffer per eye, where the graphics driver has two.
enum class StereoMode : std::uint8_t { mono, side_by_side, anaglyph, quad_buffer };
inline constexpr std::array<std::string_view, 4> stereo_names{"mono", "side-by-side", "anaglyph", "quad-buffer"};
std::optional<StereoMode> stereo_of_name(std::string_view name);

/// How to flip a picture on its screen so that it appears upright in a mirror.
enum class Flip : std::uint8_t { none, left_right, upside_down };

/// A plane; either side of a mirror may reflect.
struct Plane {
    Vec3 point{0.0}, normal{0.0, 0.0, 1.0};  ///< normal of unit length

    Vec3 reflected(const Vec3& position) const;
    double height(const Vec3& position) const;  ///< above the plane, along the normal
    Mat4 reflection() const;
};

/// Projection for an eye at `eye`. The depth range covers `scene`. Throws Error for a screen without area or with edges
/// that are not orthogonal within 1°, and for an eye that is not in front of it.
Projection through_screen(const Screen& screen, const Vec3& eye, const Bounds& scene);

/// The same when the eye sees the screen in a half-transparent mirror: the world appears behind the mirror, and the
/// screen shows its reflection.
Projection through_mirror(const Screen& screen, const Plane& mirror, const Vec3& eye, const Bounds& scene);

/// The eyes of a head: its x axis leads from the left to the right eye, `between` m apart.
struct Eyes {
    Vec3 left{0.0}, right{0.0};
};
Eyes eyes_of(const Pose& head, double between);

/// The picture of one eye on one screen.
struct ScreenView {
    std::size_t screen = 0;
    Vec3 eye{0.0};
    Projection projection;
};

/// Screens that show one world together. The pose of the haptic world in the viewer's world decides whether objects
/// appear where they are felt.
struct DisplayGeometry {
    std::vector<Screen> screens;
    std::optional<Plane> mirror;
    double between_eyes = 0.063;  ///< m
    Pose haptic_world;  ///< pose of the simulation in the viewer's world
    Mat3 haptic_stretch{1.0};  ///< applied first: a scaled workspace, or a device with calibrated scale and skew
    /// Offset of the picture from the haptic position, viewer's axes. 0: co-located; the study of the thesis used 0.30
    /// m along one axis (6.4.1).
    Vec3 visuo_haptic_offset{0.0};

    /// Left and right eye on every screen (`stereo`), else one in the middle. `scene` and the projections refer to the
    /// world of the simulation. Throws Error as through_screen does.
    std::vector<ScreenView> views(const Pose& head, bool stereo, const Bounds& scene) const;
    /// One picture for each eye on each screen of a display with several fixed viewpoints, such as one projector per
    /// direction.
    std::vector<ScreenView> views(const std::vector<Vec3>& eyes, const Bounds& scene) const;
    /// What one eye sees on one screen.
    ScreenView view(std::size_t screen, const Vec3& eye, const Bounds& scene) const;

    bool is_mirrored(std::size_t screen) const { return mirror && screens[screen].in_mirror; }
    /// A head that looks straight at the middle of a screen, or of its image in the mirror, from `away` m. Up is z, or
    /// y when an image lies flat.
    Pose place_before(std::size_t screen, double away) const;
    /// From the world of the simulation to the visible positions in the viewer's world.
    Mat4 seen_world() const;
};

}  // namespace tactus::display
