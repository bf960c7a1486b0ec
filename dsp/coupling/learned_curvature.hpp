// SPDX-License-Identifier: Apache-2.0
// What Gauss–Newton leaves out of the stiffness of a loaded contact: how the surfaces curve under their forces. It is
// learned from how the balance changed over the steps that were tried, by symmetric updates of rank one (Conn, Gould and
// Toint 1991) on top of the known part, as structured quasi-Newton methods do, and kept from tick to tick: a contact
// that slides is much the same a millisecond later. Where gradients jump (a trilinear field at cell faces) what was
// learned may mislead; it is used as long as it has mostly led downhill.
#pragma once

#include "dsp/geometry/symmetric6.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::coupling {

class LearnedCurvature {
public:
    void forget() noexcept { extra_ = {}; }

    /// Whether the next step should trust it. Now and then it is given another chance.
    bool is_trusted() noexcept { return trust_ > 0 || ++passed_over_ % chance_every == 0; }
    /// What came of a whole step that trusted it.
    void judge(bool went_down) noexcept {
        trust_ = went_down ? std::min(trust_ + 1, most_trust) : std::max(trust_ - 2, -most_trust);
    }

    geometry::Matrix6 added_to(const geometry::Matrix6& known) const noexcept {
        geometry::Matrix6 sum = known;
        for (std::size_t i = 0; i < 36; ++i) sum[i] += extra_[i];
        return sum;
    }

    /// Over the step s (m, rad) the gradient (N, N·m) changed by `change`, where `known` is the stiffness as far as it is
    /// known. `lever` (m) weighs turns against shifts.
    void learn(const geometry::Vector6& s, const geometry::Vector6& change, const geometry::Matrix6& known, double lever) noexcept {
        geometry::Vector6 rest{};
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
    static constexpr int most_trust = 8, chance_every = 16;
    geometry::Matrix6 extra_{};
    int trust_ = most_trust / 2;
    unsigned passed_over_ = 0;
};

}  // namespace tactus::coupling
