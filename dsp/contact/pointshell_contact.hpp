// SPDX-License-Identifier: Apache-2.0
// Contact of pointshells with voxmaps: energy, its gradient and its stiffness with respect to a small motion.
//
// The motion. One body moves; ξ = (v, ω) is a small motion of it about the world point `about`, along world axes,
// v in m, ω in rad: every point x of the body goes to about + v + exp([ω]×)(x − about). For the pose (p, R) of a body
// held at `about` = p that is p ← p + v, R ← exp([ω]×) R (in quaternions: exp(ω/2) · q). All of gradient and stiffness is
// at ξ = 0, in the order v.x v.y v.z ω.x ω.y ω.z, in N, N·m (gradient) and N/m, N/rad, N·m/rad (stiffness).
//
// With d and n = ∇d the interpolated distance and gradient at point i in world axes, r its lever from `about` and
// J = (n, r × n):
//     energy    Σ k w φ(−d)                     gradient  Σ −k w φ'(−d) J = ∂E/∂ξ
//     stiffness Σ k w φ''(−d) J Jᵀ              (Gauss–Newton: symmetric, never negative; curvature left out)
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
    /// Which of the two moves with ξ. With false the map does and the shell stands: gradient changes sign.
    bool shell_moves = true;
};

struct ContactSum {
    double energy = 0.0;  ///< J
    std::array<double, 6> gradient{};  ///< ∂energy/∂ξ
    std::array<double, 36> stiffness{};  ///< row by row, both triangles filled
    double total_force = 0.0;  ///< N, Σ k w φ' over the points: the scale of rounding errors
    double penetration = 0.0;  ///< m, of the deepest point, 0 when none is inside
    std::size_t in_contact = 0;  ///< points with a force
    std::size_t evaluated = 0;  ///< points whose distance was looked up
    bool reduced = false;  ///< the budget did not suffice: some points were represented by a coarser level

    /// On the moving body, about `about`, world axes.
    Wrench wrench() const noexcept {
        return {{-gradient[0], -gradient[1], -gradient[2]}, {-gradient[3], -gradient[4], -gradient[5]}};
    }
};

/// Every point of every pair, in double precision, one after the other: what the vectorised form is measured against.
/// Pairs with a pose that is no pose, without points or without a map are left out. Does not allocate.
ContactSum contact_reference(std::span<const ContactPair> pairs, const Vec3& about, const ContactLaw& law) noexcept;

/// What is to be computed; the rest of the sum stays zero. `energy` serves a line search.
enum class ContactParts : std::uint8_t { energy, all };

/// The same sums, vectorised and culled. Results do not depend on the processor: every variant of the kernel does the
/// same single-precision operations in the same order. Differs from the reference by less than 1e-5 of Σ|f|.
class PointshellContact {
public:
    /// Room for `most_nodes` nodes: the sum of shell->nodes.size() over the pairs of a call. Memory is taken here and
    /// not later; with less room the parts farthest apart stay coarse.
    explicit PointshellContact(std::size_t most_nodes);

    /// At most `budget` points are evaluated, but at least the coarsest chunk of each pair that may touch (64 points).
    /// When the budget is too small the tree is refined level by level, nearest parts first, and where it is not, a
    /// coarser point stands for those around it: forces are then approximate, and may step when the choice changes.
    ContactSum operator()(std::span<const ContactPair> pairs, const Vec3& about, const ContactLaw& law,
                          std::size_t budget = std::numeric_limits<std::size_t>::max(),
                          ContactParts parts = ContactParts::all) noexcept;

private:
    struct Entry {
        std::uint32_t pair, node;
        double clearance;
    };

    /// Fills chosen_ with the nodes to be evaluated; returns how many of them had to stay coarse.
    std::size_t choose(std::span<const ContactPair> pairs, double blend, std::size_t budget) noexcept;

    std::vector<Entry> frontier_, next_, chosen_;
};

}  // namespace tactus::contact
