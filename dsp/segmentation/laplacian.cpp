// SPDX-License-Identifier: Apache-2.0
#include "dsp/segmentation/laplacian.hpp"

#include <array>
#include <cstddef>

namespace tactus::segmentation {

namespace {

// The number of sides is a template parameter, so that the sums of a row stay in registers.
template <int sides>
void multiply_sides(const Laplacian& a, const float* b, const float* x, float* y) {
    const std::size_t rows = a.rows();
    for (std::size_t n = 0; n < rows; ++n) {
        std::array<float, static_cast<std::size_t>(sides)> sum;
        for (int s = 0; s < sides; ++s)
            sum[static_cast<std::size_t>(s)] =
                a.diagonal[n] * x[n * static_cast<std::size_t>(sides) + static_cast<std::size_t>(s)];
        for (std::uint32_t e = a.start[n]; e < a.start[n + 1]; ++e) {
            const float w = a.weight[e];
            const float* other = x + static_cast<std::size_t>(a.column[e]) * static_cast<std::size_t>(sides);
            for (int s = 0; s < sides; ++s) sum[static_cast<std::size_t>(s)] -= w * other[s];
        }
        for (int s = 0; s < sides; ++s) {
            const std::size_t at = n * static_cast<std::size_t>(sides) + static_cast<std::size_t>(s);
            y[at] = b == nullptr ? sum[static_cast<std::size_t>(s)] : b[at] - sum[static_cast<std::size_t>(s)];
        }
    }
}

void dispatch(const Laplacian& a, int sides, const float* b, const float* x, float* y) {
    switch (sides) {
        case 1: return multiply_sides<1>(a, b, x, y);
        case 2: return multiply_sides<2>(a, b, x, y);
        case 3: return multiply_sides<3>(a, b, x, y);
        default: return multiply_sides<4>(a, b, x, y);
    }
}

}  // namespace

void multiply(const Laplacian& a, int sides, const float* x, float* y) { dispatch(a, sides, nullptr, x, y); }

void residual(const Laplacian& a, int sides, const float* b, const float* x, float* r) { dispatch(a, sides, b, x, r); }

FreeNodes free_nodes(const VoxelGraph& graph, std::span<const NodeState> state) {
    FreeNodes out;
    out.row.assign(graph.nodes(), -1);
    for (std::size_t n = 0; n < graph.nodes(); ++n)
        if (state[n] == NodeState::free) {
            out.row[n] = static_cast<std::int32_t>(out.node.size());
            out.node.push_back(static_cast<std::uint32_t>(n));
        }
    const std::size_t rows = out.node.size();

    const auto around = neighbours_of(graph);
    Laplacian& a = out.matrix;
    a.start.reserve(rows + 1);
    a.column.reserve(rows * 6);
    a.weight.reserve(rows * 6);
    a.diagonal.reserve(rows);
    for (const std::uint32_t n : out.node) {
        float sum = 0.0f;
        const auto add = [&](std::int32_t other, float weight) {
            if (other < 0 || state[static_cast<std::size_t>(other)] == NodeState::left_out) return;
            sum += weight;
            if (const std::int32_t row = out.row[static_cast<std::size_t>(other)]; row >= 0) {
                a.column.push_back(row);
                a.weight.push_back(weight);
            }
        };
        for (std::size_t axis = 3; axis-- > 0;) {
            const std::int32_t other = around[n][axis + 3];
            add(other, other < 0 ? 0.0f : graph.weight[static_cast<std::size_t>(other)][axis]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) add(graph.next[n][axis], graph.weight[n][axis]);
        a.diagonal.push_back(sum);
        a.start.push_back(static_cast<std::uint32_t>(a.column.size()));
    }
    return out;
}

}  // namespace tactus::segmentation
