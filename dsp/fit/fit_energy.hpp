// SPDX-License-Identifier: Apache-2.0
// Energy of two painted surfaces that should fit, in the form that the coupling's solver uses.
//
// A painted point at signed distance d of the other bone, with outward normal n and the other's gradient g there, has
// the weight w = share · max(0, −n·g)^power: mating surfaces have opposite normals. Its energy is
//
//     robust       ½ K w s² d² / (s² + d²)       on both sides of the surface; points far beyond s have little force
//     steady       F w · (d² / 2δ up to δ, then d − δ/2, up to `reach`)   for d > 0: a pull of constant size (thesis 6.1.2)
//     intact       ½ K v d²                       only of what is not chipped, for the last steps
//
// Bone can be missing between two pieces, but none is added: `intact` leaves out all points within 6 s of one that is
// more than s off the other bone, because the rims of chips are rounded and lie nearly on it. The remaining points have
// the weight v = w (1 − d²/s²)² for d > 0 and w min(1, s / |d|) for d < 0, which avoids a bias into the chips. If less
// than a fifth of the weight would remain, no point is left out.
//
// with gradients of J = (g, r × g) and the stiffness of the touching parabola, as in pointshell_contact.hpp. The
// points of the outline pull along ½(n_x + n_y) towards their nearest partner y, which is zero for two points of one
// circular arc, so that a curved contour continues without a step. The weights are those of the last update: they are
// constant within one solve, so that the energy has the stated gradient.
//
// A kerf is bone that was lost over the whole faces. Both faces belong to one fracture that opened along the normal of
// its plane: the energy at a pose is that of the closed faces, with the moving one shifted back by the opening. The
// distance between rough faces varies with their slopes; therefore w is the mean distance, and w / (mean cosine) the
// opening.
#pragma once

#include "dsp/contact/pointshell_contact.hpp"
#include "dsp/fit/fit_surface.hpp"
#include "dsp/geometry/point_tree.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace tactus::fit {

enum class FitKernel : std::uint8_t { robust, steady, intact };

/// The two halves of the energy, which can be evaluated separately: the moving points in the fixed field with the
/// outline, and the fixed points in the moving field.
enum class FitHalf : std::uint8_t { moving_points, fixed_points };

struct FitLaw {
    FitKernel kernel = FitKernel::robust;
    double strength = 10e3;  ///< robust: K, N/m over all points of a side; steady: F, N
    double scale = 0.5e-3;  ///< m, s of the robust and the intact kernel
    double reach = 8e-3;  ///< m: maximum distance of a pull
    double soft = 0.3e-3;  ///< m, δ of the steady kernel
    double power = 1.0;  ///< exponent of the collinearity
    bool two_sided = true;  ///< also tests the fixed body's paint against the moving body's field
    bool gated = true;  ///< only where the nearest surface is painted too
    double outline = 0.0;  ///< weight of the outline relative to the paint
    double contact = 0.0;  ///< N/m for each moving point that is inside of the fixed bone
    std::size_t stride = 1;  ///< uses every n-th painted point
    double kerf = 0.0;  ///< m, mean width of bone lost over the whole faces, see FitEnergy
    double noise = 0.0;  ///< m, standard deviation of distances due to scan noise, see FitEnergy::noise
    double chipped = 1.0;  ///< fraction of the weight in chips, see FitEnergy::share_beyond
};

/// Quality of a fit at a pose.
struct FitQuality {
    double score = 0.0;  ///< mean over both paints of collinearity · exp(−d² / 2σ²), 0 to 1
    double covered = 0.0;  ///< fraction of both paints within 2σ of the other and with opposite normals
    double rms = 0.0;  ///< m, of the distances within the overlap
    double overlap = 0.0;  ///< m² of the moving paint that is covered
    double share = 0.0;  ///< mean covered area of both, as a fraction of the smaller paint; at most 1
    double penetration = 0.0;  ///< m, exceeded by 1 % of the points of paint and outline of both sides
    double gap = 0.0;  ///< m, mean signed distance of the overlap, kerf included: positive when bone is missing
    double outline = 0.0;  ///< m, median step of the outer contour; 0 without an outline
};

/// Returns the unit direction in which a kerf separates the moving face from the fixed one, fixed frame. Depends only
/// on the rotation of `pose`.
Vec3 opening_direction(const FitSurface& moving, const FitSurface& fixed, const Pose& pose) noexcept;

class FitEnergy {
public:
    FitLaw law;

    /// Both surfaces must outlive this object. Allocates here only.
    FitEnergy(const FitSurface& moving, const FitSurface& fixed);

    /// Reserves memory for other surfaces with up to this many points and outline points.
    void reserve(std::size_t points, std::size_t outline);
    /// Replaces the surfaces; does not allocate within the reserved memory.
    void rebind(const FitSurface& moving, const FitSurface& fixed) noexcept;

    const FitSurface& moving() const noexcept { return *moving_; }
    const FitSurface& fixed() const noexcept { return *fixed_; }

    /// Updates weights and partners for this pose of the moving centroid's frame in the fixed centroid's frame.
    void look(const Pose& pose) noexcept;
    /// Energy, gradient and stiffness about the origin of the moving frame, in the form of a contact for a coupling.
    contact::ContactSum operator()(const Pose& pose, contact::ContactParts parts) noexcept;
    /// The same for one half, with its weights updated.
    contact::ContactSum look_at_half(FitHalf half, const Pose& pose) noexcept;
    double clearance(const Pose&) const noexcept { return 0.0; }
    /// Returns the pose at which the faces would be in contact without the kerf.
    Pose closed(const Pose& pose) const noexcept { return closed(pose, opening(pose)); }

    /// Returns the standard deviation in m of the distances of both sides at the last look. It is estimated from their
    /// median, so that chips and paint beyond the rim have no effect.
    double noise() noexcept;
    /// Returns the fraction of the weight of both sides at the last look that is farther than `distance` (m) from the
    /// other bone.
    double share_beyond(double distance) const noexcept;

    /// `sigma`, m: distance at which a point counts 0.6. Of the law, only `stride` and `kerf` apply.
    FitQuality quality(const Pose& pose, double sigma) noexcept;

private:
    struct Side {
        const FitSurface *points = nullptr, *field = nullptr;
        std::vector<double> weight;
        std::vector<volume::Sample> seen;  ///< of the field at `seen_at`, for every `seen_stride`-th point; 0: none
        Pose seen_at;
        std::size_t seen_stride = 0;
    };
    struct Link {
        Vec3 from{0.0}, to{0.0}, along{0.0};  ///< moving frame, fixed frame, fixed frame
        double weight = 0.0;
    };

    /// Displacement of the moving face by the opening at this pose, m, fixed frame; zero without a kerf.
    Vec3 opening(const Pose& pose) const noexcept;
    static Pose closed(const Pose& pose, const Vec3& opening) noexcept;
    /// Samples the field at all points, unless the last call had the same pose: most poses are evaluated twice.
    void read(Side& side, const Pose& into) const noexcept;
    void look(Side& side, const Pose& into) noexcept;
    /// Sets the weight of all points near chips to zero, and weights the others by their distance.
    void leave_out_chips(Side& side) noexcept;
    void link(const Pose& pose) noexcept;
    void add(contact::ContactSum& sum, Side& side, const Pose& pose, const Pose& into, double sign) const noexcept;
    void add_outline(contact::ContactSum& sum, const Pose& pose) const noexcept;

    const FitSurface *moving_ = nullptr, *fixed_ = nullptr;
    std::array<Side, 2> sides_{};
    std::vector<Link> links_;
    std::vector<double> depths_, kept_;
    std::vector<Vec3> chips_;
    geometry::PointTree chip_tree_;
    std::size_t link_count_ = 0;
    Vec3 opening_{0.0};  ///< at the last look
};

}  // namespace tactus::fit
