// SPDX-License-Identifier: Apache-2.0
// The linear system of a random walk: a symmetric matrix with one row per free node.
#pragma once

#include "dsp/segmentation/voxel_graph.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::segmentation {

/// Symmetric positive definite matrix with positive diagonal and negative off-diagonal entries, row by row.
struct Laplacian {
    std::vector<std::uint32_t> start{0};  ///< first entry of each row; one more at the end
    std::vector<std::int32_t> column;
    std::vector<float> weight;    ///< negative of the matrix entry
    std::vector<float> diagonal;  ///< sum of the weights of the row and of its conductances to fixed nodes

    std::size_t rows() const { return diagonal.size(); }
};

/// Vectors of several right-hand sides, interleaved: value n * sides + side.
/// y = A x.
void multiply(const Laplacian& a, int sides, const float* x, float* y);
/// r = b - A x.
void residual(const Laplacian& a, int sides, const float* b, const float* x, float* r);

/// The free nodes of a graph as a linear system. Nodes in state `fixed` have given values, those `left_out` are
/// ignored.
enum class NodeState : std::uint8_t { free, fixed, left_out };
struct FreeNodes {
    std::vector<std::uint32_t> node;  ///< of each row
    std::vector<std::int32_t> row;    ///< of each node; -1: none
    Laplacian matrix;
};
FreeNodes free_nodes(const VoxelGraph& graph, std::span<const NodeState> state);

}  // namespace tactus::segmentation
