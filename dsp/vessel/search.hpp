// SPDX-License-Identifier: Apache-2.0
// Searches the next steps of a vessel.
#pragma once

#include "dsp/vessel/tracker.hpp"

#include <vector>

namespace tactus::vessel {

/// Inputs of a search.
struct Search {
    const Scan& scan;
    const TrackSettings& settings;
    Window window;
    Sampling sampling;
    /// Thresholds of t-statistics that pure noise does not reach (`tactus bench vessel --case noise`): of one step, of
    /// the mean over the look-ahead, of the tube at the seed, and of the mean over the nodes of a whole branch.
    double min_score = 3.5, min_mean = 5.0, min_start = 6.0, min_branch = 7.5;
};

/// Returns the distance from the axis to the edge of the vessel, m, where the brightness, averaged along the axis,
/// falls below half of the contrast. It is the third smallest of twelve directions, at most four radii.
double edge_distance(const Scan& scan, const Tube& tube);

/// Returns the best fitting tube around `seed`, of any direction and radius, at most 1.3 times as wide as the distance
/// to the edge. Score 0 if there is none.
Tube best_start(const Search& search, const Vec3& seed);

/// Positions already covered by earlier tracks.
struct Taken {
    Vec3 position;
    double radius;
    int branch;
};

struct OneWay {
    std::vector<Tube> tubes;  ///< without the start
    End end = End::contrast;
    int meets = -1;  ///< for End::meets_track
};

/// Follows a vessel from `start` along its direction.
OneWay follow_one_way(const Search& search, const Tube& start, const std::vector<Taken>& taken, double max_length);

/// Score of a side branch that leaves a vessel, and its first tube.
struct SideBranch {
    Tube tube;
    int node;
};
/// Returns the tubes that leave the branch through its wall, best first.
std::vector<SideBranch> side_branches(const Search& search, const Branch& branch, const std::vector<Taken>& taken);

}  // namespace tactus::vessel
