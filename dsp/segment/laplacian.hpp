// SPDX-License-Identifier: Apache-2.0
// The equations of a random walk: a symmetric matrix with one row per free node.
#pragma once

#include "dsp/segment/voxel_graph.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tactus::segment {

/// Symmetric positive definite matrix with positive diagonal and negative entries beside it, row by row.
struct Laplacian {
    std::vector<std::uint32_t> start{0};  ///< first entry of each row, and of the next row
    std::vector<std::int32_t> column;
    std::vector<float> weight;    ///< minus the entry of the matrix
    std::vector<float> diagonal;  ///< sum of the weights of the row and of its conductance to fixed nodes

    std::size_t rows() const { return diagonal.size(); }
};

/// Vectors of several right sides, interleaved: value n * sides + side.
/// y = A x.
void multiply(const Laplacian& a, int sides, const float* x, float* y);
/// r = b - A x.
void residual(const Laplacian& a, int sides, const float* b, const float* x, float* r);

/// What is free in a graph, as equations. Nodes in state `fixed` are held, those `left_out` do not take part.
enum class NodeState : std::uint8_t { free, fixed, left_out };
struct FreeNodes {
    std::vector<std::uint32_t> node;  ///< of each row
    std::vector<std::int32_t> row;    ///< of each node; -1: none
    Laplacian matrix;
};
FreeNodes free_nodes(const VoxelGraph& graph, std::span<const NodeState> state);

}  // namespace tactus::segment
