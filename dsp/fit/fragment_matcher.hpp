// SPDX-License-Identifier: Apache-2.0
// Which of the fragments that stand does a fragment fit, and where: a solver for the background, in bounded time and
// without memory of its own making once it is constructed.
//
// A fragment from the middle of a bone has a face for each neighbour it broke from. Pairs of faces that are near and look
// against each other where the fragment is held are fitted one by one, by the two-sided robust energy of fit_energy.hpp
// with a scale that narrows. What fits best leads; then all faces that fit there are fitted together, so that an error of
// one does not add to that of the next. When nothing near fits, every face is tried on every other in all ways round, a
// pair or two at a time.
#pragma once

#include "dsp/fit/arrangement.hpp"
#include "dsp/fit/fit.hpp"
#include "dsp/fit/fit_energy.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::fit {

/// What is known of a fragment: the points of its whole surface, those of its fracture labelled, and its distances.
struct FragmentSurface {
    std::span<const contact::SurfacePoint> points;
    const volume::Grid* distance = nullptr;
};

struct FragmentMatch {
    int moving = Arrangement::none, partner = Arrangement::none;
    Pose pose;  ///< of the moving fragment, in the frame of the poses that were given
    FitVerdict verdict = FitVerdict::no_match;
    FitQuality quality;  ///< of the pair of faces that leads
    double margin = 0.0;  ///< to the second best pose, as share of the best score
    int faces = 0;  ///< pairs of faces that were fitted together
};

/// Faces of a fragment from the middle are smaller than whole fractures: less of them has to match.
inline FitSettings settings_of_faces() noexcept {
    FitSettings settings;
    settings.widest = 3e-3;
    settings.outline = 0.0;
    settings.least_score = 0.2;
    settings.most_penetration = 0.6e-3;
    // What chips leave of a bias adds up along a chain of pieces: half of what a single pair takes.
    settings.polish = 0.05e-3;
    return settings;
}

struct MatcherSettings {
    FitSettings fit = settings_of_faces();  ///< widened for the coarsest of the fragments' scans
    double near = 15e-3;  ///< m: middles of faces that are tried on each other; the farthest that one is moved
    double most_turn = 0.7;  ///< rad, the farthest that it is turned
    double least_share = 0.5;  ///< of the leading score: what other faces must have to take part
    std::size_t most_pairs = 6;  ///< of faces that one call fits, nearest first
    std::size_t most_joined = 16;  ///< pairs of faces that are fitted together at most
    std::size_t most_points = 700;  ///< of each face that take part
    std::size_t most_faces = 400;  ///< of all fragments; each takes some megabytes
};

class FragmentMatcher {
public:
    MatcherSettings settings;

    /// Throws Error when a fragment's points and distances do not belong together, and when all have more than
    /// `most_faces`. A fragment without paint fits nothing. Memory grows with the number of faces.
    explicit FragmentMatcher(std::span<const FragmentSurface> fragments, const MatcherSettings& wanted = {});

    std::size_t faces() const noexcept { return faces_.size(); }
    std::size_t faces_of(int fragment) const noexcept;

    /// From where it is. `stands`: which fragments count as partners; the moving one does not.
    const FragmentMatch& near(int moving, std::span<const Pose> poses, std::span<const char> stands) noexcept;
    /// Wherever it is: the next pair of faces in turn, in all ways round. Returns the best match since `begin_search`,
    /// beside its partner wherever that is now; other fragments that stand: a new search.
    const FragmentMatch& search(int moving, std::span<const Pose> poses, std::span<const char> stands) noexcept;
    void begin_search() noexcept;
    /// Pairs of faces that `search` still has to try; 0: it starts over.
    std::size_t left() const noexcept { return left_; }

private:
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
    };
    class Together;

    FitEnergy& energy(std::size_t slot, const Pair& pair) noexcept;
    Pose world(const Pair& pair, const Pose& centres, std::span<const Pose> poses) const noexcept;
    Pose centres(const Pair& pair, const Pose& moving, std::span<const Pose> poses) const noexcept;
    Solved solve(const Pair& pair, std::span<const Pose> starts) noexcept;
    void join(const Solved& best, const Pose& at, std::span<const Pose> poses, std::span<const char> stands) noexcept;
    void lead(const Solved& best, std::span<const Pose> poses, std::span<const char> stands) noexcept;
    bool same_search(int moving, std::span<const char> stands) noexcept;

    std::vector<Face> faces_;
    std::vector<FitEnergy> energies_;  ///< the first for one pair at a time, all for those that are fitted together
    std::vector<Pair> pairs_;
    std::vector<Solved> solved_;
    std::vector<Pair> joined_;
    FragmentMatch match_, found_;
    Fit free_;
    Pose found_beside_;  ///< of the match found, in its partner's frame
    std::vector<char> stood_;  ///< when the search began
    std::size_t left_ = 0, next_ = 0;
};

}  // namespace tactus::fit
