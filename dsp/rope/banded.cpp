// SPDX-License-Identifier: Apache-2.0
#include "dsp/rope/banded.hpp"

namespace tactus::rope {

bool BlockBand::solve(std::vector<Vec3>& x) noexcept {
    const std::size_t shift = size_ % 2;
    right_[0] = {};
    for (std::size_t n = 0; n < middle_ + 2; ++n)
        for (int a = 0; a < 3; ++a) right_[n][static_cast<std::size_t>(a)][0] = x[n][a];
    for (std::size_t n = shift; n < middle_; ++n)
        for (int a = 0; a < 3; ++a) right_[n][static_cast<std::size_t>(a)][1] = x[size_ - 1 - n + shift][a];
    for (std::size_t n = middle_; n < middle_ + 2; ++n)
        for (std::size_t a = 0; a < 3; ++a) right_[n][a][1] = 0.0;

    const Pair one{1.0, 1.0};
    Pair least = one;  // of all pivots, as far as it is below 1
    for (std::size_t k = 0; k < middle_; ++k) {
        Column &here = columns_[k], &after = columns_[k + 1], &later = columns_[k + 2];
        auto& d = here.diagonal;
        // The point's own block.
        const Pair inverse0 = one / d[0], l10 = d[1] * inverse0, l20 = d[2] * inverse0;
        const Pair pivot1 = d[3] - l10 * d[1], inverse1 = one / pivot1;
        const Pair below = d[4] - l20 * d[1], l21 = below * inverse1;
        const Pair pivot2 = d[5] - l20 * d[2] - l21 * below, inverse2 = one / pivot2;
        least = d[0] < least ? d[0] : least;
        least = pivot1 < least ? pivot1 : least;
        least = pivot2 < least ? pivot2 : least;
        d = {inverse0, l10, l20, inverse1, l21, inverse2};
        // Its rows of the next two points: unscaled, then divided by the pivots.
        Block unscaled_next = here.next, unscaled_second = here.second;
        for (std::size_t a = 0; a < 3; ++a) {
            unscaled_next[3 + a] -= l10 * unscaled_next[a];
            unscaled_next[6 + a] -= l20 * unscaled_next[a] + l21 * unscaled_next[3 + a];
            unscaled_second[3 + a] -= l10 * unscaled_second[a];
            unscaled_second[6 + a] -= l20 * unscaled_second[a] + l21 * unscaled_second[3 + a];
            here.next[a] = unscaled_next[a] * inverse0;
            here.next[3 + a] = unscaled_next[3 + a] * inverse1;
            here.next[6 + a] = unscaled_next[6 + a] * inverse2;
            here.second[a] = unscaled_second[a] * inverse0;
            here.second[3 + a] = unscaled_second[3 + a] * inverse1;
            here.second[6 + a] = unscaled_second[6 + a] * inverse2;
        }
        const auto product = [](const Block& left, std::size_t a, const Block& right, std::size_t b) {
            return left[a] * right[b] + left[3 + a] * right[3 + b] + left[6 + a] * right[6 + b];
        };
        for (std::size_t b = 0, n = 0; b < 3; ++b)
            for (std::size_t a = b; a < 3; ++a, ++n) {
                after.diagonal[n] -= product(here.next, a, unscaled_next, b);
                later.diagonal[n] -= product(here.second, a, unscaled_second, b);
            }
        for (std::size_t b = 0; b < 3; ++b)
            for (std::size_t a = 0; a < 3; ++a) after.next[3 * b + a] -= product(here.second, a, unscaled_next, b);
        // The right side.
        Right& y = right_[k];
        y[1] -= l10 * y[0];
        y[2] -= l20 * y[0] + l21 * y[1];
        for (std::size_t a = 0; a < 3; ++a) {
            right_[k + 1][a] -= here.next[a] * y[0] + here.next[3 + a] * y[1] + here.next[6 + a] * y[2];
            right_[k + 2][a] -= here.second[a] * y[0] + here.second[3 + a] * y[1] + here.second[6 + a] * y[2];
        }
    }
    if (!(least[0] > 0.0 && least[1] > 0.0) || !solve_middle(x)) return false;
    for (std::size_t a = 0; a < 3; ++a) {
        const int axis = static_cast<int>(a);
        right_[middle_][a] = Pair{x[middle_][axis], x[middle_ + 1][axis]};
        right_[middle_ + 1][a] = Pair{x[middle_ + 1][axis], x[middle_][axis]};
    }
    for (std::size_t k = middle_; k-- > 0;) {
        const Column& here = columns_[k];
        const auto& d = here.diagonal;
        const Right &after = right_[k + 1], &later = right_[k + 2];
        Right& y = right_[k];
        Right t{y[0] * d[0], y[1] * d[3], y[2] * d[5]};
        for (std::size_t c = 0; c < 3; ++c)
            t[c] -= here.next[3 * c] * after[0] + here.next[3 * c + 1] * after[1] + here.next[3 * c + 2] * after[2] +
                    here.second[3 * c] * later[0] + here.second[3 * c + 1] * later[1] +
                    here.second[3 * c + 2] * later[2];
        y[2] = t[2];
        y[1] = t[1] - d[4] * y[2];
        y[0] = t[0] - d[1] * y[1] - d[2] * y[2];
    }
    for (std::size_t n = 0; n < middle_; ++n)
        for (int a = 0; a < 3; ++a) x[n][a] = right_[n][static_cast<std::size_t>(a)][0];
    for (std::size_t n = shift; n < middle_; ++n)
        for (int a = 0; a < 3; ++a) x[size_ - 1 - n + shift][a] = right_[n][static_cast<std::size_t>(a)][1];
    return true;
}

/// The two points where the halves meet: six equations.
bool BlockBand::solve_middle(std::vector<Vec3>& x) noexcept {
    constexpr std::size_t size = 6;
    std::array<std::array<double, size>, size> m{};  // lower triangle
    std::array<double, size> v{};
    const Column &one = columns_[middle_], &two = columns_[middle_ + 1];
    for (std::size_t b = 0, n = 0; b < 3; ++b)
        for (std::size_t a = b; a < 3; ++a, ++n) {
            m[a][b] = one.diagonal[n][0] + two.diagonal[n][1];
            m[3 + a][3 + b] = two.diagonal[n][0] + one.diagonal[n][1];
        }
    for (std::size_t b = 0; b < 3; ++b)
        for (std::size_t a = 0; a < 3; ++a) m[3 + a][b] = one.next[3 * b + a][0] + one.next[3 * a + b][1];
    for (std::size_t a = 0; a < 3; ++a) {
        v[a] = right_[middle_][a][0] + right_[middle_ + 1][a][1];
        v[3 + a] = right_[middle_ + 1][a][0] + right_[middle_][a][1];
    }
    for (std::size_t j = 0; j < size; ++j) {
        if (!(m[j][j] > 0.0) || !std::isfinite(m[j][j])) return false;
        const double inverse = 1.0 / m[j][j];
        for (std::size_t i = j + 1; i < size; ++i) {
            const double factor = m[i][j] * inverse;
            for (std::size_t k = j + 1; k <= i; ++k) m[i][k] -= factor * m[k][j];
            v[i] -= factor * v[j];
        }
        for (std::size_t i = j + 1; i < size; ++i) m[i][j] *= inverse;
        m[j][j] = inverse;
    }
    for (std::size_t i = size; i-- > 0;) {
        v[i] *= m[i][i];
        for (std::size_t k = i + 1; k < size; ++k) v[i] -= m[k][i] * v[k];
    }
    x[middle_] = Vec3(v[0], v[1], v[2]);
    x[middle_ + 1] = Vec3(v[3], v[4], v[5]);
    return true;
}

}  // namespace tactus::rope
