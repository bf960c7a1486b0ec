// SPDX-License-Identifier: Apache-2.0
// Eigenvalues and eigenvectors of small symmetric matrices by cyclic Jacobi rotations.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace tactus::geometry {

/// Eigenvalues ascending; eigenvectors of unit length as rows, in the same order.
template <std::size_t N>
struct SymmetricEigen {
    std::array<double, N> value{};
    std::array<std::array<double, N>, N> vector{};
};

namespace jacobi {

/// One Jacobi rotation, which makes m(p, q) zero.
template <std::size_t N>
void rotate(std::array<double, N * N>& m, std::array<std::array<double, N>, N>& vectors, std::size_t p,
            std::size_t q) noexcept {
    const double off = m[N * p + q];
    if (off == 0.0) return;
    const double theta = (m[(N + 1) * q] - m[(N + 1) * p]) / (2.0 * off);
    const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
    for (std::size_t k = 0; k < N; ++k) {
        const double kp = m[N * k + p], kq = m[N * k + q];
        m[N * k + p] = c * kp - s * kq;
        m[N * k + q] = s * kp + c * kq;
    }
    for (std::size_t k = 0; k < N; ++k) {
        const double pk = m[N * p + k], qk = m[N * q + k];
        m[N * p + k] = c * pk - s * qk;
        m[N * q + k] = s * pk + c * qk;
        const double vp = vectors[p][k], vq = vectors[q][k];
        vectors[p][k] = c * vp - s * vq;
        vectors[q][k] = s * vp + c * vq;
    }
}

}  // namespace jacobi

/// Eigenvalues and eigenvectors of the symmetric matrix `m` (row by row): twelve sweeps, more than these sizes need.
template <std::size_t N>
SymmetricEigen<N> symmetric_eigen(std::array<double, N * N> m) noexcept {
    std::array<std::array<double, N>, N> vectors{};
    for (std::size_t i = 0; i < N; ++i) vectors[i][i] = 1.0;
    for (int sweep = 0; sweep < 12; ++sweep)
        for (std::size_t p = 0; p + 1 < N; ++p)
            for (std::size_t q = p + 1; q < N; ++q) jacobi::rotate<N>(m, vectors, p, q);
    std::array<std::size_t, N> order{};
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return m[(N + 1) * i]; });
    SymmetricEigen<N> eigen;
    for (std::size_t i = 0; i < N; ++i) {
        eigen.value[i] = m[(N + 1) * order[i]];
        eigen.vector[i] = vectors[order[i]];
    }
    return eigen;
}

}  // namespace tactus::geometry
