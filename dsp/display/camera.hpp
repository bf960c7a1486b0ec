// SPDX-License-Identifier: Apache-2.0
// Orbit camera. World frame: LPS, so x is to the patient's left, y to the back, z up.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <optional>
#include <string_view>

namespace tactus::display {

using Mat4 = glm::dmat4;

/// Matrix from local coordinates to the surrounding frame.
Mat4 matrix_of(const Pose& pose);

/// View and projection: world to eye frame (x right, y up, z towards the eye), then to clip space.
struct Projection {
    Mat4 to_eye{1.0}, to_clip{1.0};
    bool is_mirrored = false;  ///< triangles have the opposite winding

    /// Image position of a point: (−1, −1) lower left, (1, 1) upper right. None behind the eye.
    std::optional<glm::dvec2> seen(const Vec3& world) const;
};

/// View directions by key number: 1 front, 2 back, 3 left, 4 right, 5 top, 6 bottom, 7 iso.
enum class NamedView { front, back, left, right, top, bottom, iso };
inline constexpr std::array<std::string_view, 7> view_names{"front", "back", "left", "right", "top", "bottom", "iso"};
std::optional<NamedView> view_of_name(std::string_view name);
std::optional<NamedView> view_of_number(int number);

/// A box along the axes, m; empty while low > high.
struct Bounds {
    Vec3 low{1e30}, high{-1e30};

    bool empty() const { return low.x > high.x; }
    void add(const Vec3& point);
    void add(const Bounds& other);
    Vec3 middle() const { return 0.5 * (low + high); }
    double radius() const;  ///< of the bounding sphere
    std::array<Vec3, 8> corners() const;
};

class OrbitCamera {
public:
    Vec3 target{0.0};
    double distance = 0.3;  ///< from eye to target, m
    Quat orientation{1.0, 0.0, 0.0, 0.0};  ///< of the eye's axes in the world
    double vertical_field_of_view_rad = 0.6;

    OrbitCamera() { look_from(NamedView::iso); }

    Vec3 eye() const { return target + orientation * Vec3(0.0, 0.0, distance); }

    /// Sets the direction; target and distance stay.
    void look_from(NamedView view);
    /// Iso view from the side of the middle of `box` on which `tool` lies, so that the tool is visible.
    void look_from_side_of(const Vec3& tool, const Bounds& box);
    /// The same from any direction: `towards` is the viewing direction.
    void look_along(const Vec3& towards, const Vec3& up = {0.0, 0.0, 1.0});
    /// Orbits about the target: to the right about the world's z, and upwards. rad.
    void orbit(double right, double up);
    /// Pans: the scene follows the hand; in shares of the picture's height.
    void pan(double right, double up);
    /// Zooms: divides the distance by `factor`.
    void zoom(double factor);
    /// Fits the box into a picture of `aspect` = width / height, as near as possible. Does nothing for an empty
    /// box.
    void fit(const Bounds& box, double aspect, double margin = 1.06);

    /// Size of a pixel at the depth of the target, in a picture of this height in pixels.
    double metres_per_pixel(int height) const;
    /// With the depth range as tight around `scene` as possible.
    Projection projection(double aspect, const Bounds& scene) const;
};

/// Near and far planes for `scene` along −z of an eye frame, with a margin, for the best depth resolution.
struct DepthRange {
    double near = 0.01, far = 10.0;  ///< m
};
DepthRange depth_range(const Mat4& to_eye, const Bounds& scene);

}  // namespace tactus::display
