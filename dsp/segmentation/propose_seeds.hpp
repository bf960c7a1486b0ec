// SPDX-License-Identifier: Apache-2.0
// Proposes strokes for the fragments of a scan, for manual correction.
#pragma once

#include "dsp/segmentation/strokes.hpp"
#include "dsp/segmentation/voxel_graph.hpp"
#include "dsp/volume/grid.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::segmentation {

struct ProposeSeeds {
    double depth = 3e-3;        ///< m: depth of erosion to find cores; less where the bone is thin
    double weakest = 0.25;      ///< regions with a stronger connection are merged; see propose_seeds
    double max_without_core = 0.05;  ///< of the nodes; with more, or one fragment, the bone is eroded less
    double min_share = 0.01;  ///< fraction of all nodes: a smaller fragment gets no proposal
    std::size_t strokes = 8;    ///< maximum per fragment
};

struct ProposedFragment {
    std::vector<Stroke> strokes;
    std::size_t nodes = 0;  ///< nodes of the graph nearest to it
};

/// Erodes the bright part of the graph to cores, assigns each node to the nearest core, and merges regions until no two
/// are connected by a conductance of more than `weakest` · (nodes of the smaller one)^(2/3). The remaining regions are
/// fragments: they touch over a small or a dark face. Their strokes lie at positions far from each other. Largest
/// fragment first.
std::vector<ProposedFragment> propose_seeds(const VoxelGraph& graph, const volume::Grid& values, const GapLaw& law,
                                            const ProposeSeeds& how = {});

}  // namespace tactus::segmentation
