// SPDX-License-Identifier: Apache-2.0
// Pointshell-voxmap contact: energy, its gradient and its stiffness with respect to a small motion.
//
// One body moves. ξ = (v, ω) is a small motion of it about the world point `about`, along world axes, v in m, ω in rad:
// every point x of the body goes to about + v + exp([ω]×)(x − about). For the pose (p, R) of a body with `about` = p
// this is p ← p + v, R ← exp([ω]×) R (in quaternions: exp(ω/2) · q). Gradient and stiffness are taken at ξ = 0, in the
// order v.x v.y v.z ω.x ω.y ω.z, in N, N·m (gradient) and N/m, N/rad, N·m/rad (stiffness).
//
// With d and n = ∇d the interpolated distance and gradient at point i in world axes, r its lever from `about` and
// J = (n, r × n):
//     energy    Σ k w φ(−d)                     gradient  Σ −k w φ'(−d) J = ∂E/∂ξ
//     stiffness Σ k w φ''(−d) J Jᵀ              (Gauss–Newton: symmetric, positive semidefinite; curvature left out)
// The wrench on the moving body is −gradient, about `about`. In the thesis' mode n in J is the point's inward normal.
#pragma once

#include "dsp/contact/contact_law.hpp"
#include "dsp/contact/pointshell.hpp"
#include "dsp/contact/voxmap.hpp"
#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tactus::contact {

/// A shell near a voxmap, both with poses in the world.
struct ContactPair {
    const Pointshell* shell = nullptr;
    Pose shell_pose;
    const Voxmap* map = nullptr;
    Pose map_pose;
    /// True: the shell moves with ξ. False: the map moves and the shell is fixed; the gradient changes sign.
    bool shell_moves = true;
};

struct ContactSum {
    double energy = 0.0;  ///< J
    std::array<double, 6> gradient{};  ///< ∂energy/∂ξ
    std::array<double, 6> contact_gradient{};  ///< the part of `gradient` from points; others may add to `gradient`
    std::array<double, 36> stiffness{};  ///< row by row, both triangles filled
    double total_force = 0.0;  ///< N, Σ k w φ' over the points: the scale of rounding errors
    double penetration = 0.0;  ///< m, of the deepest point, 0 when none is inside
    std::size_t in_contact = 0;  ///< points with a force
    std::size_t evaluated = 0;  ///< points whose distance was evaluated
    bool reduced = false;  ///< the budget was too small: a coarser level represents some points

    /// Wrench on the moving body about `about`, world axes.
    Wrench wrench() const noexcept {
        return {{-gradient[0], -gradient[1], -gradient[2]}, {-gradient[3], -gradient[4], -gradient[5]}};
    }
};

/// Reference implementation: every point of every pair, in double precision, sequentially; it is the reference in tests
/// of the vectorised form. Skips pairs with an invalid pose, without points or without a map. Does not allocate.
ContactSum contact_reference(std::span<const ContactPair> pairs, const Vec3& about, const ContactLaw& law) noexcept;

/// The parts to compute; the rest of the sum stays zero. `energy` is for line searches.
enum class ContactParts : std::uint8_t { energy, all };

/// The same sums, vectorised and culled. The result does not depend on the processor: every variant of the kernel does
/// the same single-precision operations in the same order. Differs from the reference by less than 1e-5 of Σ|f|.
class PointshellContact {
public:
    /// Capacity for `max_nodes` nodes: the sum of shell->nodes.size() over the pairs of a call. All memory is
    /// allocated here; when the capacity is exceeded, the farthest parts use coarser levels.
    explicit PointshellContact(std::size_t max_nodes);

    /// Evaluates at most `budget` points, but at least the coarsest chunk (64 points) of each pair that may touch. When
    /// the budget is too small, the tree is refined level by level, nearest parts first, and elsewhere a coarser point
    /// represents its neighbours. Forces are then approximate, and may jump when the selection changes.
    ContactSum operator()(std::span<const ContactPair> pairs, const Vec3& about, const ContactLaw& law,
                          std::size_t budget = std::numeric_limits<std::size_t>::max(),
                          ContactParts parts = ContactParts::all) noexcept;

private:
    struct Entry {
        std::uint32_t pair, node;
        double clearance;
    };

    /// Fills chosen_ with the nodes to evaluate; returns how many of them could not be refined.
    std::size_t choose(std::span<const ContactPair> pairs, double blend, std::size_t budget) noexcept;

    std::vector<Entry> frontier_, next_, chosen_;
};

}  // namespace tactus::contact
