// SPDX-License-Identifier: Apache-2.0
#include "dsp/reconstruction/placed_cuts.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/reconstruction/donor_bone.hpp"
#include "dsp/reconstruction/plan_frame.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::reconstruction {

namespace {

/// rad: the axes of two segments that are closer to parallel determine their joint poorly.
constexpr double min_joint_angle = 10.0 * degree;
/// Of the rolls of the segments: the iteration converges within some rounds, to less than the smallest twist, rad.
constexpr int max_roll_rounds = 30;
constexpr double min_twist = 1e-12;

/// The donor's line where a segment was placed, along the order of the jaw's planes.
struct PlacedAxis {
    Vec3 point{0.0}, direction{0.0};

    Vec3 nearest_to(const Vec3& p) const { return point + glm::dot(p - point, direction) * direction; }
};

Vec3 on_plane(const PlacedAxis& axis, const JawPlane& plane, std::size_t segment) {
    const Vec3 normal = glm::normalize(*plane.normal);
    const double along = glm::dot(normal, axis.direction);
    if (!(std::abs(along) > std::cos(max_tilt)))
        throw Error(fmt::format("segment {} lies nearly along the cut of the jaw that it should meet", segment + 1));
    return axis.point + glm::dot(plane.origin - axis.point, normal) / along * axis.direction;
}

/// `faces`: a point between the two faces of the joint.
Vec3 joint_of(const PlacedAxis& a, const PlacedAxis& b, const Vec3& faces) {
    const Vec3 across = glm::cross(a.direction, b.direction);
    const double sine2 = glm::dot(across, across);
    if (!(std::sqrt(sine2) > std::sin(min_joint_angle))) return 0.5 * (a.nearest_to(faces) + b.nearest_to(faces));
    const Vec3 between = b.point - a.point;
    const double s = glm::dot(glm::cross(between, b.direction), across) / sine2,
                 t = glm::dot(glm::cross(between, a.direction), across) / sine2;
    return 0.5 * (a.point + s * a.direction + b.point + t * b.direction);
}

/// Rotation about `axis` that is part of `turn`, rad.
double twist_about(const Quat& turn, const Vec3& axis) {
    const double along = glm::dot(Vec3(turn.x, turn.y, turn.z), axis);
    return std::remainder(2.0 * std::atan2(along, turn.w), 2.0 * pi);
}

/// Sets `y` of each segment's first plane so that its roll is that of the placed piece. The projection of y into a tilted
/// plane makes this an iteration.
void set_rolls(FibulaInputs& inputs, std::span<const Pose> placed, const std::vector<Vec3>& axes) {
    FibulaInputs bare = inputs;
    bare.donor.reset();
    bare.along_line.clear();
    const DonorBone donor(bare);
    for (std::size_t n = 0; n < placed.size(); ++n) {
        // Any direction across the axis begins the iteration.
        const Vec3 up = std::abs(axes[n].z) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, 1.0, 0.0);
        bare.planes[n].y = glm::normalize(up - glm::dot(up, axes[n]) * axes[n]);
    }
    for (int round = 0; round < max_roll_rounds; ++round) {
        const FibulaPlan plan = plan_fibula(bare, donor);
        double most = 0.0;
        for (std::size_t n = 0; n < placed.size(); ++n) {
            const Quat turn = placed[n].orientation * glm::conjugate(plan.segments[n].donor_to_target.orientation);
            const double twist = twist_about(turn, axes[n]);
            bare.planes[n].y = glm::angleAxis(twist, axes[n]) * *bare.planes[n].y;
            most = std::max(most, std::abs(twist));
        }
        if (most < min_twist) break;
    }
    for (std::size_t n = 0; n < placed.size(); ++n) inputs.planes[n].y = bare.planes[n].y;
}

/// Whether two neighbouring segments use the same part of the line.
bool overlap_along(const FibulaInputs& inputs) {
    for (std::size_t n = 0; n + 1 < inputs.along_line.size(); ++n) {
        const std::size_t low = inputs.reversed ? n + 1 : n, high = inputs.reversed ? n : n + 1;
        const double length = glm::length(inputs.planes[low + 1].origin - inputs.planes[low].origin);
        if (inputs.along_line[high] < inputs.along_line[low] + length) return true;
    }
    return false;
}

}  // namespace

PlacedCuts cuts_of_placed(const FibulaInputs& planned_inputs, const FibulaPlan& planned, std::span<const Pose> placed) {
    PlacedCuts made;
    FibulaInputs& inputs = made.inputs = planned_inputs;
    inputs.from_curve.reset();
    const std::size_t count = planned.segments.size();
    const Vec3 line = glm::normalize(inputs.line_direction);
    std::vector<PlacedAxis> axes;
    for (const Pose& pose : placed)
        axes.push_back({pose.apply(inputs.line_point), pose.rotate(inputs.reversed ? -line : line)});
    inputs.planes.front().origin = on_plane(axes.front(), inputs.planes.front(), 0);
    inputs.planes.back().origin = on_plane(axes.back(), inputs.planes.back(), count - 1);
    for (std::size_t n = 1; n < count; ++n) {
        const Vec3 faces = 0.5 * (placed[n - 1].apply(planned.segments[n - 1].donor_plane[1].origin) +
                                  placed[n].apply(planned.segments[n].donor_plane[0].origin));
        inputs.planes[n] = {joint_of(axes[n - 1], axes[n], faces), {}, {}};
    }
    std::vector<Vec3> along;
    for (std::size_t n = 0; n < count; ++n)
        along.push_back(glm::normalize(inputs.planes[n + 1].origin - inputs.planes[n].origin));
    // The roll of the whole donor is in the rolls of its segments.
    inputs.roll = 0.0;
    set_rolls(inputs, placed, along);
    inputs.along_line.clear();
    for (std::size_t n = 0; n < count; ++n) {
        const Vec3 distal = placed[n].inverse().apply(inputs.planes[inputs.reversed ? n + 1 : n].origin);
        inputs.along_line.push_back(glm::dot(distal - inputs.line_point, line));
    }
    made.is_spaced_anew = overlap_along(inputs);
    if (!made.is_spaced_anew) {
        made.plan = plan_fibula(inputs);
        // Tilted cuts may overlap where the axes do not.
        made.is_spaced_anew = std::ranges::any_of(made.plan.clearances,
                                                  [](const auto& clearance) { return clearance && *clearance < 0.0; });
    }
    if (made.is_spaced_anew) {
        inputs.along_line.clear();
        made.plan = plan_fibula(inputs);
    }
    for (std::size_t n = 0; n < count; ++n) {
        const FibulaSegment& segment = made.plan.segments[n];
        const Pose& now = segment.donor_to_target;
        const Vec3 middle = 0.5 * (segment.donor_plane[0].origin + segment.donor_plane[1].origin);
        // On another part of the donor only the axis can be compared.
        const Vec3 off = now.apply(middle) - placed[n].apply(middle);
        const Vec3 beside = off - glm::dot(off, along[n]) * along[n];
        made.moved.push_back(glm::length(made.is_spaced_anew ? beside : off));
        made.turned.push_back(glm::length(rotation_between(placed[n].orientation, now.orientation)));
    }
    return made;
}

}  // namespace tactus::reconstruction
