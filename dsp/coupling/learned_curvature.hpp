// SPDX-License-Identifier: Apache-2.0
// What Gauss–Newton leaves out of the stiffness of a loaded contact: how the surfaces curve under their forces. It is
// learned from how the balance changed over the steps that were tried, by symmetric updates of rank one (Conn, Gould and
// Toint 1991) on top of the known part, as structured quasi-Newton methods do, and kept from tick to tick: a contact
// that slides is much the same a millisecond later.
#pragma once

#include "dsp/coupling/symmetric6.hpp"

#include <cmath>

namespace tactus {

class LearnedCurvature {
public:
    void forget() noexcept { extra_ = {}; }

    Matrix6 added_to(const Matrix6& known) const noexcept {
        Matrix6 sum = known;
        for (std::size_t i = 0; i < 36; ++i) sum[i] += extra_[i];
        return sum;
    }

    /// Over the step s (m, rad) the gradient (N, N·m) changed by `change`, where `known` is the stiffness as far as it is
    /// known. `lever` (m) weighs turns against shifts.
    void learn(const Vector6& s, const Vector6& change, const Matrix6& known, double lever) noexcept {
        Vector6 rest{};
        double along = 0.0, rests = 0.0, steps = 0.0;
        for (std::size_t i = 0; i < 6; ++i) {
            rest[i] = change[i];
            for (std::size_t j = 0; j < 6; ++j) rest[i] -= (known[6 * i + j] + extra_[6 * i + j]) * s[j];
            const double scale = i < 3 ? 1.0 : lever;
            along += rest[i] * s[i];
            rests += rest[i] * rest[i] / (scale * scale);
            steps += s[i] * s[i] * scale * scale;
        }
        // A rest nearly across the step says nothing about the curvature along it.
        if (!(std::abs(along) > least_share * std::sqrt(rests * steps))) return;
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j) extra_[6 * i + j] += rest[i] * rest[j] / along;
    }

private:
    static constexpr double least_share = 1e-3;
    Matrix6 extra_{};
};

}  // namespace tactus
