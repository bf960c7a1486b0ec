// SPDX-License-Identifier: Apache-2.0
// What following a vessel gives: a tree of branches with radius, contrast and confidence along each.
#pragma once

#include "dsp/vessel/noise.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::vessel {

/// A place on the centre line.
struct Node {
    Vec3 position{0.0};    ///< m
    Vec3 direction{0.0};   ///< unit, along the branch
    double radius = 0.0;   ///< m
    double contrast = 0.0; ///< values of the scan
    double score = 0.0;    ///< t-statistic of the contrast in a window of about one radius
    double confidence = 0.0;  ///< 0 to 1, see confidence_of
    double along = 0.0;    ///< m from the start of the branch
    bool is_lost = false;  ///< within a stretch without contrast, that was bridged
    bool is_radius_uncertain = false;  ///< below 1.5 samples: blur decides, or contrast was held
};

/// Why a branch ends.
enum class End { contrast, noise, border, excluded, larger_vessel, meets_track, forks, length };
/// "the contrast is lost", …: the end of a sentence "a branch ends where …".
std::string_view reason_of(End end);

struct LostStretch {
    double from = 0.0, to = 0.0;  ///< m along the branch
};

/// Narrowest place of a branch, outside of its parent's reach.
struct Stenosis {
    std::size_t node = 0;
    double radius = 0.0;            ///< m
    double reference_radius = 0.0;  ///< m: of the vessel before and after it, interpolated
    double percent = 0.0;           ///< narrowing of the diameter; 100 in a lost stretch
    double error_percent = 0.0;     ///< standard deviation of it; 0: not fitted, as it is no narrowing or a long one
    bool is_uncertain = false;      ///< the percentage may be wrong by more than ten
};

struct Branch {
    std::vector<Node> nodes;
    int parent = -1;       ///< branch that this one leaves; -1: the branch of the seed
    int parent_node = -1;  ///< index of the node of the parent where it leaves
    End start = End::contrast;  ///< of the branch of the seed; others start at their parent
    End end = End::contrast;
    int meets = -1;        ///< branch that it meets at its end, for End::meets_track
    double free_from = 0.0;  ///< m along: before it the parent is so near that it adds to the radius
    std::optional<Stenosis> stenosis;  ///< none for branches shorter than six radii

    double length() const { return nodes.empty() ? 0.0 : nodes.back().along; }
    /// Stretches of at least two nodes. A single node without contrast, as at a fork, is none.
    std::vector<LostStretch> lost() const;
};

struct Track {
    std::vector<Branch> branches;  ///< the first holds the seed
    std::size_t seed_node = 0;     ///< of the first branch
    Noise noise;                   ///< near the seed
    double background = 0.0, contrast = 0.0;  ///< at the seed
    double excluded_above = 0.0;   ///< values above are bone or stent; infinity: none
    std::vector<std::string> doubts;  ///< why the whole may be no vessel, see doubts_of; empty: it looks like one

    double length() const;
};

}  // namespace tactus::vessel
