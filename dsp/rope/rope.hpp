// SPDX-License-Identifier: Apache-2.0
// A vessel or string under tension: it stretches, bends, sags, and slides over bone.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/rope/banded.hpp"
#include "dsp/rope/obstacle.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace tactus::rope {

struct RopeMaterial {
    double stiffness = 1.9;  ///< N per unit of strain; it resists stretch, not compression (see artery)
    double bending = 0.0;  ///< N·m²: moment per curvature
    double weight = 0.0;  ///< N/m, along -z
    double drag = 0.02;  ///< N·s/m²: force per length and velocity; keeps slack parts at rest
    double radius = 0.0;  ///< m, distance kept between centreline and bone
    double friction = 0.0;  ///< Coulomb coefficient on bone
};

/// A fibular artery of 3.0 mm outer diameter and 0.45 mm wall: 3.6 mm² that carry 62 kPa at the stretch in the leg,
/// 1.12 (Struczewska and others 2024, PMC11456514). The law is assumed to be linear between rest and that point.
RopeMaterial artery();
/// Length of a vessel when cut free, divided by its length in the leg: 1 / 1.12.
inline constexpr double free_over_in_situ = 0.89;

struct RopeSettings {
    int substeps = 4;  ///< maximum per tick
    double way = 0.1e-3;  ///< m per substep of the fastest held point: slower motion needs fewer substeps
    int max_iterations = 8;  ///< Newton steps per permitted substep; later substeps reserve half of theirs
    double tolerance = 1e-5;  ///< N: a substep ends when the largest unbalanced force at a point is below this
    double contact_stiffness = 4e3;  ///< N/m per point in contact; implicit, so it may be high
    double stick_stiffness = 4e3;  ///< N/m per sticking point
};

struct RopeStep {
    double residual = 0.0;  ///< N: largest unbalanced force at a free point after a substep
    int iterations = 0;  ///< sum over all substeps
    double lag = 0.0;  ///< m: largest distance of a held point from its target
    int contacts = 0;
    bool is_solved = false;  ///< the residual of every substep was within the tolerance
};

/// A chain of points with given rest lengths between them. Each substep minimises
///     stretch + bending + weight + contact + friction + drag · |x - x_before|² / 2h
/// by Newton's method on the banded system of the whole chain. Each iteration updates the active set (taut segments,
/// contacts) until it matches the solution of the linear system. A step is halved, then damped, until the sum
/// decreases. Friction is modelled by springs to anchor points, which follow when the limit μN, with N of the last
/// substep, is reached, so that it does not creep. Stretch, bending and friction are convex functions of the points, so
/// that an implicit substep releases no more energy than it stored. Ticks do not allocate.
class Rope {
public:
    /// `rest`: one per segment, all positive, m. Throws Error for fewer than 3 points or invalid values.
    Rope(std::vector<Vec3> points, std::vector<double> rest, const RopeMaterial& material,
         const RopeSettings& settings = {});

    /// Holds a point: it moves to `place` during the next ticks, by at most half a segment per substep.
    void hold(std::size_t point, const Vec3& place) noexcept;
    void release(std::size_t point) noexcept;
    /// Applies a force to a point that is not held, N; a force that is not finite is ignored.
    void load(std::size_t point, const Vec3& force) noexcept {
        if (is_finite(force)) load_[point] = force;
    }
    /// Fixes the direction of the rope (unit length, from the first point to the last) at the first or last point.
    void clamp_first(const std::optional<Vec3>& direction) noexcept;
    void clamp_last(const std::optional<Vec3>& direction) noexcept;

    /// Computes one tick of h s. `bone` may be null.
    RopeStep step(double h, const Obstacle* bone) noexcept;

    std::span<const Vec3> points() const noexcept { return x_; }
    std::span<const double> rest() const noexcept { return rest_; }
    double tension(std::size_t segment) const noexcept;  ///< N, by the law at the current points
    /// Force of the rope on the holder of a point, N, by the law at the current points.
    Vec3 pull_on(std::size_t point) const noexcept;
    double energy() const noexcept;  ///< J, including contact and sticking
    double length() const noexcept;
    double rest_length() const noexcept;
    const RopeMaterial& material() const noexcept { return material_; }
    /// True if the point was in contact at the end of the last tick.
    bool touches(std::size_t point) const noexcept { return depth_[point] > 0.0; }

private:
    struct Stick {
        Vec3 anchor{0.0}, normal{0.0};
        double limit = 0.0;  ///< N; 0: the point did not touch
    };

    struct Curve {
        Vec3 along{0.0};  // unit
        double bend = 0.0;  // 1/m, from the change of the normal along the last step
    };

    double potential(double drag) const noexcept;
    double gradient(double drag) noexcept;
    void assemble_base(double drag) noexcept;
    void assemble(double damping, bool with_curves) noexcept;
    bool go(bool has_move, int max_halvings, double drag, const Obstacle* bone, double& now) noexcept;
    void learn_curves() noexcept;
    int find_move(double damping, int max_rounds) noexcept;
    void measure() noexcept;
    void look_at(const Obstacle* bone, bool is_anew) noexcept;
    bool substep(double h, const Obstacle* bone, int max_iterations, RopeStep& report) noexcept;
    void begin_friction() noexcept;
    void end_friction() noexcept;
    double clamped_weight(double l, bool is_clamped) const noexcept;
    Vec3 bend_at(std::size_t point) const noexcept;
    Vec3 slip(std::size_t point) const noexcept;

    RopeMaterial material_;
    RopeSettings settings_;
    std::vector<Vec3> x_, before_, trial_, move_, rest_of_gradient_, load_, target_, normal_, normal_before_, seen_;
    std::vector<double> rest_, depth_;
    std::vector<double> length_;  // of the segments at the current points
    std::vector<double> share_;  // m of rope per point
    std::vector<double> bend_;  // energy of a point's bending is weight · |bend|² / 2
    std::vector<double> clear_;  // m around `seen_` within which a point stays clear of the bone
    std::vector<bool> held_;
    std::vector<char> resists_, touching_;  // the active set
    std::vector<Stick> stick_;
    std::vector<Curve> curve_;
    std::array<std::optional<Vec3>, 2> clamp_;
    BlockBand band_, base_;  // base: the part that is constant within a substep
};

}  // namespace tactus::rope
