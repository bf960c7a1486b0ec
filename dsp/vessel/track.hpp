// SPDX-License-Identifier: Apache-2.0
// Result of tracking a vessel: a tree of branches with radius, contrast and confidence along each.
#pragma once

#include "dsp/vessel/noise.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::vessel {

/// A point of the centre line.
struct Node {
    Vec3 position{0.0};    ///< m
    Vec3 direction{0.0};   ///< unit, along the branch
    double radius = 0.0;   ///< m
    double contrast = 0.0; ///< values of the scan
    double score = 0.0;    ///< t-statistic of the contrast in a window of about one radius
    double confidence = 0.0;  ///< 0 to 1, see confidence_of
    double along = 0.0;    ///< m from the start of the branch
    bool is_lost = false;  ///< within a bridged stretch without contrast
    bool is_radius_uncertain = false;  ///< below 1.5 samples, where blur dominates, or with a fixed contrast
};

/// Reason of the end of a branch.
enum class End { contrast, noise, border, excluded, larger_vessel, meets_track, forks, length };
/// Returns the end of the sentence "a branch ends where …": "the contrast is lost".
std::string_view reason_of(End end);

struct LostStretch {
    double from = 0.0, to = 0.0;  ///< m along the branch
};

/// The narrowest position of a branch, outside of its parent's reach.
struct Stenosis {
    std::size_t node = 0;
    double radius = 0.0;            ///< m
    double reference_radius = 0.0;  ///< m: of the vessel before and after it, interpolated
    double percent = 0.0;           ///< narrowing of the diameter; 100 in a lost stretch
    double error_percent = 0.0;     ///< its standard deviation; 0: not fitted (no narrowing, or a long one)
    bool is_uncertain = false;      ///< the percentage may be wrong by more than ten
};

struct Branch {
    std::vector<Node> nodes;
    int parent = -1;       ///< branch from which this one starts; -1: the branch of the seed
    int parent_node = -1;  ///< index of the parent's node where it starts
    End start = End::contrast;  ///< for the branch of the seed; others start at their parent
    End end = End::contrast;
    int meets = -1;        ///< branch that it meets at its end, for End::meets_track
    double free_from = 0.0;  ///< m along: before it the nearby parent increases the measured radius
    std::optional<Stenosis> stenosis;  ///< none for branches shorter than six radii

    double length() const { return nodes.empty() ? 0.0 : nodes.back().along; }
    /// Returns lost stretches of at least two nodes. A single node without contrast, as at a fork, does not count.
    std::vector<LostStretch> lost() const;
};

struct Track {
    std::vector<Branch> branches;  ///< the first holds the seed
    std::size_t seed_node = 0;     ///< of the first branch
    Noise noise;                   ///< near the seed
    double background = 0.0, contrast = 0.0;  ///< at the seed
    double excluded_above = 0.0;   ///< values above are bone or stent; infinity: none
    std::vector<std::string> doubts;  ///< reasons why the whole track may not be a vessel, see doubts_of; empty: none

    double length() const;
};

}  // namespace tactus::vessel
