// SPDX-License-Identifier: Apache-2.0
#include "dsp/snap/hold.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tactus {

namespace {

/// One rotation that makes m(p, q) nought.
void rotate(Matrix6& m, std::array<Vector6, 6>& vectors, std::size_t p, std::size_t q) noexcept {
    const double off = m[6 * p + q];
    if (off == 0.0) return;
    const double theta = (m[7 * q] - m[7 * p]) / (2.0 * off);
    const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
    for (std::size_t k = 0; k < 6; ++k) {
        const double kp = m[6 * k + p], kq = m[6 * k + q];
        m[6 * k + p] = c * kp - s * kq;
        m[6 * k + q] = s * kp + c * kq;
    }
    for (std::size_t k = 0; k < 6; ++k) {
        const double pk = m[6 * p + k], qk = m[6 * q + k];
        m[6 * p + k] = c * pk - s * qk;
        m[6 * q + k] = s * pk + c * qk;
        const double vp = vectors[p][k], vq = vectors[q][k];
        vectors[p][k] = c * vp - s * vq;
        vectors[q][k] = s * vp + c * vq;
    }
}

}  // namespace

Eigen6 eigen_of(Matrix6 m) noexcept {
    std::array<Vector6, 6> vectors{};
    for (std::size_t i = 0; i < 6; ++i) vectors[i][i] = 1.0;
    for (int sweep = 0; sweep < 12; ++sweep)
        for (std::size_t p = 0; p < 5; ++p)
            for (std::size_t q = p + 1; q < 6; ++q) rotate(m, vectors, p, q);
    std::array<std::size_t, 6> order{};
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return m[7 * i]; });
    Eigen6 eigen;
    for (std::size_t i = 0; i < 6; ++i) {
        eigen.value[i] = m[7 * order[i]];
        eigen.vector[i] = vectors[order[i]];
    }
    return eigen;
}

void find_free(Fit& fit, const Matrix6& stiffness, double radius, double least_hold) {
    const double lever = std::max(radius, 1e-6);
    const double weight = stiffness[0] + stiffness[7] + stiffness[14];  // directions have unit length: Σ k n·n
    Matrix6 m{};
    if (weight > 0.0)
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j)
                m[6 * i + j] = stiffness[6 * i + j] / (weight * (i < 3 ? 1.0 : lever) * (j < 3 ? 1.0 : lever));
    const Eigen6 eigen = eigen_of(m);
    fit.hold = eigen.value;
    fit.free.clear();
    for (std::size_t n = 0; n < 6 && eigen.value[n] < least_hold; ++n) {
        const Vector6& v = eigen.vector[n];
        const Vec3 way(v[0], v[1], v[2]), turn(v[3], v[4], v[5]);
        const bool is_turn = glm::length(turn) > glm::length(way);
        fit.free.push_back({is_turn, glm::normalize(is_turn ? turn : way)});
    }
}

}  // namespace tactus
