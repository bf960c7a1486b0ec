// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/screen.hpp"

#include "dsp/core/error.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::display {

namespace {

void check(const Screen& screen) {
    const double width = glm::length(screen.right()), height = glm::length(screen.up());
    if (!is_finite(screen.low_left) || !(width > 1e-3) || !(height > 1e-3))
        throw Error("a screen needs three corners at least 1 mm apart");
    if (!(std::abs(glm::dot(screen.right(), screen.up())) < std::sin(0.01745) * width * height))
        throw Error("the edges of a screen must be square to each other within 1 deg; calibrate its corners again");
}

/// Bounds of a transformed box.
Bounds moved(const Bounds& box, const Mat4& by) {
    Bounds moved;
    if (!box.empty())
        for (const Vec3& corner : box.corners()) moved.add(Vec3(by * glm::dvec4(corner, 1.0)));
    return moved;
}

}  // namespace

Vec3 Screen::normal() const { return glm::normalize(glm::cross(right(), up())); }

std::optional<StereoMode> stereo_of_name(std::string_view name) {
    const auto found = std::ranges::find(stereo_names, name);
    if (found == stereo_names.end()) return std::nullopt;
    return static_cast<StereoMode>(found - stereo_names.begin());
}

double Plane::height(const Vec3& position) const { return glm::dot(position - point, normal); }

Vec3 Plane::reflected(const Vec3& position) const { return position - 2.0 * height(position) * normal; }

Mat4 Plane::reflection() const {
    Mat4 matrix(1.0);
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) matrix[column][row] -= 2.0 * normal[row] * normal[column];
    matrix[3] = glm::dvec4(2.0 * glm::dot(point, normal) * normal, 1.0);
    return matrix;
}

Projection through_screen(const Screen& screen, const Vec3& eye, const Bounds& scene) {
    check(screen);
    const Vec3 right = glm::normalize(screen.right()), normal = screen.normal(), up = glm::cross(normal, right);
    const Vec3 to_corner = screen.low_left - eye;
    const double away = -glm::dot(normal, to_corner);
    if (!is_finite(eye) || !(away > 1e-3)) throw Error("the eye must be in front of the screen, 1 mm off at least");
    Projection projection;
    for (int axis = 0; axis < 3; ++axis) {
        projection.to_eye[axis][0] = right[axis];
        projection.to_eye[axis][1] = up[axis];
        projection.to_eye[axis][2] = normal[axis];
    }
    projection.to_eye[3] = glm::dvec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(normal, eye), 1.0);
    const auto [near, far] = depth_range(projection.to_eye, scene);
    const double left = glm::dot(right, to_corner), low = glm::dot(up, to_corner), share = near / away;
    projection.to_clip = glm::frustum(left * share, (left + glm::length(screen.right())) * share, low * share,
                                      (low + glm::length(screen.up())) * share, near, far);
    return projection;
}

Projection through_mirror(const Screen& screen, const Plane& mirror, const Vec3& eye, const Bounds& scene) {
    const Mat4 reflection = mirror.reflection();
    // Light takes the same path from the reflected world to the reflected eye, straight through the screen.
    Projection projection = through_screen(screen, mirror.reflected(eye), moved(scene, reflection));
    projection.to_eye = projection.to_eye * reflection;
    projection.is_mirrored = true;
    return projection;
}

Eyes eyes_of(const Pose& head, double between) {
    const Vec3 half = head.rotate(Vec3(0.5 * between, 0.0, 0.0));
    return {head.position - half, head.position + half};
}

Pose DisplayGeometry::place_before(std::size_t screen, double away) const {
    const Screen& seen = screens[screen];
    check(seen);
    const Vec3 right = glm::normalize(seen.right()), up = glm::normalize(seen.up()), normal = seen.normal();
    const Vec3 middle = seen.low_left + 0.5 * (seen.right() + seen.up());
    if (!is_mirrored(screen)) return {middle + away * normal, glm::quat_cast(Mat3(right, up, normal))};
    const auto turned = [this](const Vec3& v) { return v - 2.0 * glm::dot(v, mirror->normal) * mirror->normal; };
    // The mirror image has left and right swapped, or is upside down: chooses the one with up on top, or, where the
    // image lies flat, far on top.
    const Vec3 high = turned(up), back = turned(normal);
    const double way = (std::abs(high.z) > 0.1 ? high.z : high.y) < 0.0 ? -1.0 : 1.0;
    return {mirror->reflected(middle + away * normal), glm::quat_cast(Mat3(-way * turned(right), way * high, back))};
}

Mat4 DisplayGeometry::seen_world() const {
    return matrix_of(Pose{visuo_haptic_offset, {1.0, 0.0, 0.0, 0.0}} * haptic_world) * Mat4(haptic_stretch);
}

ScreenView DisplayGeometry::view(std::size_t screen, const Vec3& eye, const Bounds& scene) const {
    const Mat4 placed = seen_world();
    const Bounds world = moved(scene, placed);
    ScreenView view{screen, eye, {}};
    view.projection = is_mirrored(screen) ? through_mirror(screens[screen], *mirror, eye, world)
                                          : through_screen(screens[screen], eye, world);
    view.projection.to_eye = view.projection.to_eye * placed;
    return view;
}

std::vector<ScreenView> DisplayGeometry::views(const Pose& head, bool stereo, const Bounds& scene) const {
    if (!is_valid(head)) throw Error("the pose of the head is not valid");
    const Eyes eyes = eyes_of(head, between_eyes);
    return views(stereo ? std::vector{eyes.left, eyes.right} : std::vector{head.position}, scene);
}

std::vector<ScreenView> DisplayGeometry::views(const std::vector<Vec3>& eyes, const Bounds& scene) const {
    std::vector<ScreenView> views;
    for (std::size_t screen = 0; screen < screens.size(); ++screen)
        for (const Vec3& eye : eyes) views.push_back(view(screen, eye, scene));
    return views;
}

}  // namespace tactus::display
