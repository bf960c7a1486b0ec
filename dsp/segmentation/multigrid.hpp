// SPDX-License-Identifier: Apache-2.0
// Multigrid for the linear system of a random walk, as preconditioner of a conjugate gradient solver.
#pragma once

#include "dsp/segmentation/laplacian.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::segmentation {

/// A hierarchy of coarser systems by unsmoothed aggregation (Braess, Computing 55, 1995): the nodes of a block of 2 x 2
/// x 2 cells become one node, or several where the block is split by weak conductances, so that a coarse node never
/// joins two sides of a gap. Smoothed by Chebyshev polynomials of the matrix, which is symmetric and has no order of
/// rows; the cycle is a W. A linear, symmetric and positive operator.
class Multigrid {
public:
    /// `place`: the cell of each row. `matrix` must outlive the hierarchy.
    Multigrid(const Laplacian& matrix, std::vector<std::array<std::int32_t, 3>> place);

    /// Vectors for apply, one set per thread.
    struct Workspace {
        struct Vectors {
            std::vector<float> x, b, r, d, e;
        };
        std::vector<Vectors> level;
    };
    Workspace workspace(int sides) const;

    /// z ≈ A⁻¹ r.
    void apply(int sides, const float* r, float* z, Workspace& work) const;

    std::size_t levels() const { return coarse_.size() + 1; }

private:
    struct Coarse {
        Laplacian matrix;
        std::vector<std::int32_t> of;  ///< row of this level for each row of the level below
    };

    const Laplacian& matrix(std::size_t level) const { return level == 0 ? fine_ : coarse_[level - 1].matrix; }
    void cycle(std::size_t level, int sides, const float* b, float* x, Workspace& work) const;
    void smooth(std::size_t level, int sides, const float* b, float* x, bool from_zero, Workspace& work) const;
    void solve_coarsest(int sides, const float* b, float* x) const;
    void factorise();

    const Laplacian& fine_;
    std::vector<Coarse> coarse_;
    std::vector<double> factor_;  ///< Cholesky factor of the coarsest matrix, row by row; empty if that is too large
};

}  // namespace tactus::segmentation
