// SPDX-License-Identifier: Apache-2.0
// The vessel of a flap: attached to segments of bone, free between them and where it was stripped off.
#pragma once

#include "dsp/rope/measure.hpp"
#include "dsp/rope/rope.hpp"
#include "dsp/rope/rope_shape.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace tactus::rope {

/// A part of a vessel's line that lies along a body: from one point of the line to another, both included.
struct Attachment {
    int body = 0;
    std::size_t first = 0, last = 0;
};

/// Finds the parts of a line that lie along bodies, in its order. `surfaces`: points on each body, in the frame of the
/// line. A point of the line lies along a body if the nearest point of the body is within `reach` and beside it: the
/// direction to it is within 17° of a right angle to the line. So an attachment ends where the body is cut. Of each
/// body the longest run is used; bodies with fewer than two points get none.
std::vector<Attachment> attachments_along(std::span<const Vec3> course, std::span<const std::vector<Vec3>> surfaces,
                                          double reach);

enum class Reach { slack, in_situ, stretched, no };
/// Classifies a strain from rest: none, up to that of the leg, up to 10 % beyond that, more.
Reach reach_of(double strain) noexcept;

struct AttachedVesselSettings {
    RopeMaterial material = artery();
    double pedicle = 0.0;  ///< m of the length in the leg to keep before the first body; 0: all
    std::size_t max_points = RopeShape::max_points;
    /// A tick in which a slack vessel slides over an edge may not converge; the next tick continues.
    RopeSettings solver{.max_iterations = 2, .tolerance = 2e-5};
    double sewing_speed = 0.3;  ///< m/s of the end on its path to its site
};

/// A rope from the sewn end, over the pedicle, along all bodies in the order of the line. The rest length of the free
/// parts is free_over_in_situ of their length in the leg. Only the constructor allocates.
class AttachedVessel {
public:
    /// `course` begins at the end that is sewn. `poses`: of the bodies at the start, from the frame of the line. Throws
    /// Error if nothing is attached or free, and for a line of fewer than two points.
    AttachedVessel(std::span<const Vec3> course, std::span<const Attachment> attachments, std::span<const Pose> poses,
                   const AttachedVesselSettings& settings);

    /// Computes one tick: bodies are at `poses`; `site` is the position of the sewn end, null while it is free.
    RopeStep step(double h, std::span<const Pose> poses, const Vec3* site, const Obstacle* bones) noexcept;

    /// Force of the vessel on a body, without weight: N, N·m about `about`.
    Wrench pull_on(int body, const Vec3& about) const noexcept;
    bool is_attached_to(int body) const noexcept;

    bool has_pedicle() const noexcept { return root_ > 0; }
    /// Tension of the pedicle near the first body, N, measured two segments before it, where the bend at the bone
    /// carries no force.
    double tension() const noexcept { return root_ > 0 ? rope_.tension(root_ > 3 ? root_ - 3 : 0) : 0.0; }
    double span_tension() const noexcept;  ///< the largest between two bodies, N
    /// Strain of the pedicle, length over rest length - 1; negative: slack. While the end is free, that of a straight
    /// pedicle to `site`.
    double strain(const Vec3* free_site) const noexcept;
    double bend_ratio() const noexcept;  ///< smallest radius of curvature of the pedicle over the vessel's radius
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
        Vec3 place;  // in the frame of the line
    };
    struct Layout;
    AttachedVessel(Layout layout, const AttachedVesselSettings& settings);
    static Layout layout_of(std::span<const Vec3> course, std::span<const Attachment> attachments,
                            std::span<const Pose> poses, const AttachedVesselSettings& settings);

    std::vector<Held> held_;
    std::vector<char> is_span_;  // of segments: free between two bodies
    std::size_t root_;  // index of the point where the pedicle ends
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
