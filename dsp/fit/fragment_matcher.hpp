// SPDX-License-Identifier: Apache-2.0
// Finds the placed fragments that a fragment fits, and the pose: a solver for a background thread, with bounded time
// and without allocation after construction.
//
// A fragment from the middle of a bone has one face for each former neighbour. Pairs of nearby faces with opposed
// normals are fitted one by one from the present pose, by the two-sided robust energy of fit_energy.hpp with a
// narrowing scale. Then all faces that fit at the pose of the best pair are fitted together, so that errors of single
// pairs do not accumulate. If nothing nearby fits, every face is tried on every other with all rotations, one or two
// pairs per call.
#pragma once

#include "dsp/fit/arrangement/arrangement.hpp"
#include "dsp/fit/fit.hpp"
#include "dsp/fit/fit_energy.hpp"
#include "dsp/fit/registration/healthy_pull.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace tactus::fit {

/// Data of a fragment: its surface points with labelled fracture, and its distance field.
struct FragmentSurface {
    std::span<const contact::SurfacePoint> points;
    const volume::Grid* distance = nullptr;
};

struct FragmentMatch {
    int moving = Arrangement::none, partner = Arrangement::none;
    Pose pose;  ///< of the moving fragment, in the frame of the given poses
    FitVerdict verdict = FitVerdict::no_match;
    FitQuality quality;  ///< of the leading pair of faces
    double margin = 0.0;  ///< to the second best pose, as a fraction of the best score
    FitPrecision precision;  ///< of all faces fitted together
    PoseBound bound;  ///< of the pose
    int faces = 0;  ///< number of face pairs fitted together
};

/// The fit of one pair of faces of two fragments, independent of the fragments' present poses.
struct FacePairFit {
    std::size_t moving = 0, fixed = 0;  ///< numbers of the faces in the matcher
    Pose pose;  ///< of the moving fragment in the frame of the fixed one
    double score = -1.0, second = 0.0;  ///< of the best and the second best pose; negative: none
    double overlap = 0.0;  ///< m² in contact
    Pose rival;  ///< the second best pose, like `pose`

    FacePairFit inverse() const { return {fixed, moving, pose.inverse(), score, second, overlap, rival.inverse()}; }
    /// Value of the pair for ranking; includes the area, because small patches fit by chance.
    double worth() const { return score > 0.0 ? score * std::sqrt(overlap) : 0.0; }
};

/// Settings for faces of a fragment from the middle, which are smaller than whole fractures: a smaller overlap
/// suffices.
inline FitSettings settings_of_faces() noexcept {
    FitSettings settings;
    settings.widest = 3e-3;
    settings.outline = 0.0;
    settings.max_penetration = 0.6e-3;
    // Bias from chips accumulates along a chain of fragments: half of the limit for a single pair.
    settings.polish = 0.05e-3;
    return settings;
}

struct MatcherSettings {
    FitSettings fit = settings_of_faces();  ///< widened for the coarsest of the fragments' scans
    double near = 15e-3;  ///< m: largest distance of the centroids of tried face pairs, and largest displacement
    double max_turn = 0.7;  ///< rad, greatest rotation
    double min_share = 0.5;  ///< of the best pair's score: minimum for other faces to take part
    std::size_t max_pairs = 6;  ///< maximum number of face pairs per call, nearest first
    std::size_t max_joined = 16;  ///< maximum number of face pairs fitted together
    std::size_t max_points = 700;  ///< maximum number of points per face
    HealthyPullSettings healthy;  ///< the healthy side, if it takes part in the fit
    std::size_t max_faces = 400;  ///< maximum over all fragments; each face takes some megabytes
};

class FragmentMatcher {
public:
    MatcherSettings settings;

    /// Throws Error when a fragment's points and distances do not match, and when all together have more than
    /// `max_faces`. A fragment without paint has no fit. Memory is proportional to the number of faces.
    explicit FragmentMatcher(std::span<const FragmentSurface> fragments, const MatcherSettings& wanted = {});

    std::size_t faces() const noexcept { return faces_.size(); }
    /// A painted face, numbered over all fragments; and its fragment.
    const FitSurface& face(std::size_t n) const noexcept { return faces_[n].surface; }
    int fragment_of(std::size_t face) const noexcept { return faces_[face].fragment; }
    std::size_t faces_of(int fragment) const noexcept;

    /// Local search from the present poses. `stands`: fragments that are valid partners; `moving` itself is excluded.
    const FragmentMatch& near(int moving, std::span<const Pose> poses, std::span<const char> stands) noexcept;
    /// Global search: tries the next pair of faces with all rotations. Returns the best match since `begin_search`,
    /// relative to its partner's present pose. Restarts if the set of placed fragments changes.
    const FragmentMatch& search(int moving, std::span<const Pose> poses, std::span<const char> stands) noexcept;
    void begin_search() noexcept;

    /// Tries one pair of faces with all rotations, with the smaller face in the middle and at both ends of the larger
    /// one, and from `held` (m: the moving fragment in the frame of the fixed one). For preparation: may run in several
    /// threads in parallel, each with its own energy from `make_energy`.
    FacePairFit fit_faces(FitEnergy& energy, std::size_t moving, std::size_t fixed, const Pose& held) const;
    FitEnergy make_energy() const;
    /// Fits, as `near` does, all faces that match at the fitted pose of a pair. The moving fragment is that of
    /// `pair.moving`.
    const FragmentMatch& place(const FacePairFit& pair, std::span<const Pose> poses,
                               std::span<const char> stands) noexcept;
    /// Returns the quality of a pair of faces at poses of all fragments.
    FitQuality quality_of(FitEnergy& energy, std::size_t moving, std::size_t fixed, std::span<const Pose> poses) const;
    /// Number of face pairs that `search` has not tried yet; at 0 it starts again.
    std::size_t left() const noexcept { return left_; }

private:
    static constexpr std::size_t coarse_points = 160;  ///< per face, for the comparison of starts

    struct Face {
        int fragment;
        FitSurface surface;
    };
    struct Pair {
        std::size_t moving, fixed;
        double distance;
    };
    struct Candidate {
        Pose pose;  // between centres
        double score = -1.0;
    };
    struct Solved {
        Pair pair;
        Candidate best;
        double second = 0.0;
        Pose rival;  // the second best, between centres
    };
    class Together;

    FitEnergy& energy(std::size_t slot, const Pair& pair) noexcept;
    Pose world(const Pair& pair, const Pose& centres, std::span<const Pose> poses) const noexcept;
    Pose centres(const Pair& pair, const Pose& moving, std::span<const Pose> poses) const noexcept;
    /// m: scale of the robust kernel at the start, and at the start of the refinement.
    struct Scales {
        double widest, refined;
    };
    Scales wide_scales() const noexcept { return {settings.fit.widest, 4.0 * settings.fit.finest}; }
    Solved solve(FitEnergy& energy, const Pair& pair, std::span<const Pose> starts,
                 const Scales& scales) const noexcept;
    bool is_in_doubt() const noexcept;
    double min_overlap(int moving, int partner) const noexcept;
    void join(const Solved& best, const Pose& at, std::span<const Pose> poses, std::span<const char> stands) noexcept;
    /// `wider`: scale at which all faces are first fitted together, in units of the finest one.
    void lead(const Solved& best, std::span<const Pose> poses, std::span<const char> stands,
              double wider = 3.0) noexcept;
    void confirm(const Solved& best, std::span<const Pose> poses, std::span<const char> stands) noexcept;
    bool same_search(int moving, std::span<const char> stands) noexcept;

    std::vector<Face> faces_;
    std::vector<double> paint_;  ///< m², painted area of each fragment
    std::size_t max_face_points_ = 0, max_outline_ = 0;
    std::vector<FitEnergy> energies_;  ///< the first for single pairs, all for pairs fitted together
    std::vector<HealthyPull> pulls_;  ///< of each fragment; empty without a healthy side
    std::vector<Pair> pairs_;
    std::vector<Solved> solved_;
    std::vector<Pair> joined_;
    FragmentMatch match_, found_;
    Fit free_;
    Pose found_beside_;  ///< of the best match, in its partner's frame
    std::vector<char> stood_;  ///< valid partners at the start of the search
    std::size_t left_ = 0, next_ = 0;
};

}  // namespace tactus::fit
