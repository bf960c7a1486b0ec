// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/camera.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::display {

Mat4 matrix_of(const Pose& pose) {
    Mat4 matrix = glm::mat4_cast(pose.orientation);
    matrix[3] = glm::dvec4(pose.position, 1.0);
    return matrix;
}

std::optional<glm::dvec2> Projection::seen(const Vec3& world) const {
    const glm::dvec4 clip = to_clip * (to_eye * glm::dvec4(world, 1.0));
    if (!(clip.w > 0.0)) return std::nullopt;
    return glm::dvec2(clip.x / clip.w, clip.y / clip.w);
}

std::optional<NamedView> view_of_name(std::string_view name) {
    const auto found = std::ranges::find(view_names, name);
    if (found == view_names.end()) return std::nullopt;
    return static_cast<NamedView>(found - view_names.begin());
}

std::optional<NamedView> view_of_number(int number) {
    if (number < 1 || number > static_cast<int>(view_names.size())) return std::nullopt;
    return static_cast<NamedView>(number - 1);
}

void Bounds::add(const Vec3& point) {
    if (!is_finite(point)) return;
    low = glm::min(low, point);
    high = glm::max(high, point);
}

void Bounds::add(const Bounds& other) {
    if (other.empty()) return;
    add(other.low);
    add(other.high);
}

double Bounds::radius() const { return empty() ? 0.0 : 0.5 * glm::length(high - low); }

std::array<Vec3, 8> Bounds::corners() const {
    std::array<Vec3, 8> all;
    for (std::size_t c = 0; c < 8; ++c)
        all[c] = Vec3((c & 1) != 0 ? high.x : low.x, (c & 2) != 0 ? high.y : low.y, (c & 4) != 0 ? high.z : low.z);
    return all;
}

void OrbitCamera::look_from(NamedView view) {
    const Vec3 front(0.0, -1.0, 0.0);
    switch (view) {
        case NamedView::front: return look_along({0.0, 1.0, 0.0});
        case NamedView::back: return look_along({0.0, -1.0, 0.0});
        case NamedView::left: return look_along({-1.0, 0.0, 0.0});
        case NamedView::right: return look_along({1.0, 0.0, 0.0});
        case NamedView::top: return look_along({0.0, 0.0, -1.0}, front);
        case NamedView::bottom: return look_along({0.0, 0.0, 1.0}, front);
        case NamedView::iso: return look_along({-0.6, 0.75, -0.4});
    }
}

void OrbitCamera::look_from_side_of(const Vec3& tool, const Bounds& box) {
    const Vec3 side = box.empty() || !is_finite(tool) ? Vec3(1.0, -1.0, 0.0) : tool - box.middle();
    look_along({side.x < 0.0 ? 0.6 : -0.6, side.y > 0.0 ? -0.75 : 0.75, -0.4});
}

void OrbitCamera::look_along(const Vec3& towards, const Vec3& up) {
    if (!is_finite(towards) || !(glm::length(towards) > 0.0)) return;
    const Vec3 back = -glm::normalize(towards);
    Vec3 right = glm::cross(up, back);
    if (!(glm::length(right) > 1e-9)) right = glm::cross(Vec3(0.0, -1.0, 0.0), back);
    if (!(glm::length(right) > 1e-9)) right = glm::cross(Vec3(0.0, 0.0, 1.0), back);
    right = glm::normalize(right);
    orientation = glm::normalize(glm::quat_cast(Mat3(right, glm::cross(back, right), back)));
}

void OrbitCamera::orbit(double right, double up) {
    const Vec3 back = orientation * Vec3(0.0, 0.0, 1.0);
    // Beyond a pole left and right would be swapped.
    const double height = std::asin(std::clamp(back.z, -1.0, 1.0));
    constexpr double pole = 1.5707;
    const double rise = std::clamp(height + up, -pole, pole) - height;
    orientation = glm::normalize(glm::angleAxis(right, Vec3(0.0, 0.0, 1.0)) * orientation *
                                 glm::angleAxis(-rise, Vec3(1.0, 0.0, 0.0)));
}

void OrbitCamera::pan(double right, double up) {
    const double height = 2.0 * distance * std::tan(0.5 * vertical_field_of_view_rad);
    target -= orientation * Vec3(right * height, up * height, 0.0);
}

void OrbitCamera::zoom(double factor) {
    if (factor > 0.0) distance = std::clamp(distance / factor, 1e-4, 1e3);
}

void OrbitCamera::fit(const Bounds& box, double aspect, double margin) {
    if (box.empty()) return;
    target = box.middle();
    const double tall = std::tan(0.5 * vertical_field_of_view_rad) / margin, wide = tall * aspect;
    const Quat to_eye = glm::conjugate(orientation);
    distance = 1e-4;
    for (const Vec3& corner : box.corners()) {
        const Vec3 at = to_eye * (corner - target);
        distance = std::max({distance, at.z + std::abs(at.x) / wide, at.z + std::abs(at.y) / tall});
    }
}

double OrbitCamera::metres_per_pixel(int height) const {
    return 2.0 * distance * std::tan(0.5 * vertical_field_of_view_rad) / height;
}

Projection OrbitCamera::projection(double aspect, const Bounds& scene) const {
    Projection projection;
    projection.to_eye = matrix_of(Pose{eye(), orientation}.inverse());
    const auto [near, far] = depth_range(projection.to_eye, scene);
    projection.to_clip = glm::perspective(vertical_field_of_view_rad, aspect, near, far);
    return projection;
}

DepthRange depth_range(const Mat4& to_eye, const Bounds& scene) {
    if (scene.empty()) return {};
    double near = 1e30, far = -1e30;
    for (const Vec3& corner : scene.corners()) {
        const double depth = -(to_eye * glm::dvec4(corner, 1.0)).z;
        near = std::min(near, depth);
        far = std::max(far, depth);
    }
    const double slack = 0.02 * (far - near) + 1e-4;
    far += slack;
    if (!(far > 0.0)) return {};
    // A 24-bit depth buffer then still resolves 1e-4 of the distance.
    return {std::clamp(near - slack, far * 1e-4, far * 0.95), far};
}

}  // namespace tactus::display
