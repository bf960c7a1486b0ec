// SPDX-License-Identifier: Apache-2.0
// Proposes strokes for the fragments of a scan, to be corrected by hand.
#pragma once

#include "dsp/segment/strokes.hpp"
#include "dsp/segment/voxel_graph.hpp"
#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::segment {

struct ProposeSeeds {
    double depth = 3e-3;        ///< m: how far the bone is eroded to find its cores, less where it is thin
    double weakest = 0.25;      ///< regions joined by more than this are one fragment; see propose_seeds
    double most_without_core = 0.05;  ///< share of the nodes; with more, or one fragment, the bone is eroded less
    double least_share = 0.01;  ///< of all nodes: a smaller fragment gets no proposal
    std::size_t strokes = 8;    ///< at most, per fragment
};

struct ProposedFragment {
    std::vector<Stroke> strokes;
    std::size_t nodes = 0;  ///< of the graph that are nearest to it
};

/// Erodes the bright part of the graph to cores, gives each node to the nearest core, and joins the regions until no two
/// are joined by a conductance of more than `weakest` · (nodes of the smaller one)^(2/3). What is left are fragments:
/// they touch over a small or a dark face. Their strokes lie at places that are far from each other. Largest fragment
/// first.
std::vector<ProposedFragment> propose_seeds(const VoxelGraph& graph, const volume::Grid& values, const GapLaw& law,
                                            const ProposeSeeds& how = {});

}  // namespace tactus::segment
