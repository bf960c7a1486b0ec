// SPDX-License-Identifier: Apache-2.0
// Segmentation by random walks: the label of a voxel is the seed that a walk from it reaches first with the highest
// probability.
#pragma once

#include "dsp/core/jobs.hpp"
#include "dsp/segmentation/voxel_graph.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tactus::segmentation {

/// Required accuracy of the solution.
struct WalkAccuracy {
    double residual = 1e-4;  ///< of each label, relative to its right-hand side
    int max_iterations = 200;
};

/// Result of a solve. Probabilities are interleaved: node * labels + label. Those of a node lie in [0, 1] and their sum
/// is 1 within rounding; all are 0 in parts of the graph without a seed.
struct Walks {
    int labels = 0;
    std::vector<float> probability;
    double residual = 0.0;  ///< largest of all labels, from the returned probabilities: |b - A x| / |b|
    int iterations = 0;  ///< maximum over the labels
};

/// Random walks on a graph (Grady, IEEE PAMI 28, 2006): the probability of each label at each free node solves the
/// Laplace equation with 1 at its own seeds and 0 at all others. Solved by conjugate gradients with a multigrid
/// preconditioner, several labels at once. The result does not depend on `run`.
/// `seed`: of each node, 0 for none, otherwise the number of its label from 1 to `labels`.
/// `start`: an earlier solution of as many labels on the same graph; makes the solve after a small edit faster.
Walks random_walks(const VoxelGraph& graph, std::span<const std::uint8_t> seed, int labels,
                   const WalkAccuracy& accuracy = {}, const Walks* start = nullptr, const RunJobs& run = run_in_turn);

/// Label of each node, 1 to `labels`: the most probable one, the lowest of equal ones; 0 where all are 0.
std::vector<std::uint8_t> labels_of(const Walks& walks);
/// 1 - (second largest)/(largest probability) of each node; 0 where all are 0.
std::vector<float> certainty_of(const Walks& walks);

}  // namespace tactus::segmentation
