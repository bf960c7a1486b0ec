// SPDX-License-Identifier: Apache-2.0
// The vessel of a flap: attached along pieces of bone, free where it was stripped off and between them.
#pragma once

#include "dsp/rope/measure.hpp"
#include "dsp/rope/rope.hpp"
#include "dsp/rope/rope_shape.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace tactus::rope {

/// A part of a course that lies along a body: from one point of the course to another, both included.
struct Attachment {
    int body = 0;
    std::size_t first = 0, last = 0;
};

/// Where a course lies along bodies, in its order. `surfaces`: points on each body, in the frame of the course. A point
/// of the course lies along a body when the nearest point of the body is within `reach` and beside it, not before or
/// behind it (the way there is within 17° of a right angle to the course): so an attachment ends where the body is cut.
/// Of each body the longest run counts; bodies with less than two points get none.
std::vector<Attachment> attachments_along(std::span<const Vec3> course, std::span<const std::vector<Vec3>> surfaces,
                                          double reach);

enum class Reach { slack, in_situ, stretched, no };
/// By strain from rest: none, to that of the leg, to 10 % beyond that, more.
Reach reach_of(double strain) noexcept;

struct AttachedVesselSettings {
    RopeMaterial material = artery();
    double pedicle = 0.0;  ///< m in the leg that is kept before the first body; 0: all
    std::size_t most_points = RopeShape::most_points;
    /// A tick in which a slack vessel slides over an edge may not settle: it goes on in the next one.
    RopeSettings solver{.most_iterations = 2, .tolerance = 2e-5};
    double sewing_speed = 0.3;  ///< m/s of the end on its way to its site
};

/// A rope from the end that is sewn, over the pedicle, along all bodies in the order of the course. At rest the free parts
/// have free_over_in_situ of their length in the leg. Nothing allocates after construction.
class AttachedVessel {
public:
    /// `course` begins at the end that is sewn. `poses`: of the bodies at the start, from the frame of the course.
    /// Throws Error when nothing is attached or free, and for a course of fewer than two points.
    AttachedVessel(std::span<const Vec3> course, std::span<const Attachment> attachments, std::span<const Pose> poses,
                   const AttachedVesselSettings& settings);

    /// A tick: bodies are at `poses`; `site` is where the end is sewn, null while it is free.
    RopeStep step(double h, std::span<const Pose> poses, const Vec3* site, const Obstacle* bones) noexcept;

    /// Of the vessel on a body, without weight: N, N·m about `about`.
    Wrench pull_on(int body, const Vec3& about) const noexcept;
    bool is_attached_to(int body) const noexcept;

    bool has_pedicle() const noexcept { return root_ > 0; }
    /// Of the pedicle near the first body, N: two segments before it, where the bend at the bone bears no force.
    double tension() const noexcept { return root_ > 0 ? rope_.tension(root_ > 3 ? root_ - 3 : 0) : 0.0; }
    double span_tension() const noexcept;  ///< the largest between two bodies, N
    /// Length over rest length - 1 of the pedicle; negative: slack. While the end is free, of a straight pedicle to `site`.
    double strain(const Vec3* free_site) const noexcept;
    double bend_ratio() const noexcept;  ///< least radius of curvature of the pedicle over that of the vessel
    double twist() const noexcept { return twisted_; }  ///< rad of the pedicle since it was sewn
    int contacts() const noexcept { return contacts_; }
    bool is_sewn() const noexcept { return is_sewn_; }  ///< its end is at the site
    double pedicle_rest() const noexcept { return pedicle_rest_; }  ///< m

    const Rope& rope() const noexcept { return rope_; }
    void show(RopeShape& shape) const noexcept;

private:
    struct Held {
        std::size_t point;
        int body;
        Vec3 place;  // in the frame of the course
    };
    struct Layout;
    AttachedVessel(Layout layout, const AttachedVesselSettings& settings);
    static Layout layout_of(std::span<const Vec3> course, std::span<const Attachment> attachments,
                            std::span<const Pose> poses, const AttachedVesselSettings& settings);

    std::vector<Held> held_;
    std::vector<char> is_span_;  // of segments: free between two bodies
    std::size_t root_;  // the pedicle ends at this point
    double pedicle_rest_;
    AttachedVesselSettings settings_;
    Rope rope_;
    TwistCount twist_;
    double twisted_ = 0.0;
    Vec3 site_side_{0.0}, body_side_{0.0};
    bool is_sewn_ = false, was_sewn_ = false;
    int contacts_ = 0;
};

}  // namespace tactus::rope
