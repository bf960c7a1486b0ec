// SPDX-License-Identifier: Apache-2.0
// The part of a loaded contact's stiffness that Gauss–Newton neglects: the curvature of the surfaces times their
// forces. Learned as in structured quasi-Newton methods from the change of the gradient over the tried steps, by
// symmetric rank-one updates (SR1; Conn, Gould and Toint 1991) on top of the known part, and kept from tick to tick,
// since a sliding contact changes little within a millisecond. Where gradients jump (a trilinear field at cell faces)
// the learned part may mislead; it is used as long as it has mostly led downhill.
#pragma once

#include "dsp/geometry/symmetric6.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::coupling {

class LearnedCurvature {
public:
    void forget() noexcept { extra_ = {}; }

    /// Whether the next step should use the learned part. After failures it is retried now and then.
    bool is_trusted() noexcept { return trust_ > 0 || ++passed_over_ % chance_every == 0; }
    /// Reports the result of a whole step that used it.
    void judge(bool went_down) noexcept {
        trust_ = went_down ? std::min(trust_ + 1, max_trust) : std::max(trust_ - 2, -max_trust);
    }

    geometry::Matrix6 added_to(const geometry::Matrix6& known) const noexcept {
        geometry::Matrix6 sum = known;
        for (std::size_t i = 0; i < 36; ++i) sum[i] += extra_[i];
        return sum;
    }

    /// The gradient (N, N·m) changed by `change` over the step s (m, rad); `known` is the known stiffness. `lever` (m)
    /// weighs rotations against translations.
    void learn(const geometry::Vector6& s, const geometry::Vector6& change, const geometry::Matrix6& known,
               double lever) noexcept {
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
        // SR1 safeguard: a remainder nearly orthogonal to the step holds no curvature along it.
        if (!(std::abs(along) > min_share * std::sqrt(rests * steps))) return;
        for (std::size_t i = 0; i < 6; ++i)
            for (std::size_t j = 0; j < 6; ++j) extra_[6 * i + j] += rest[i] * rest[j] / along;
    }

private:
    static constexpr double min_share = 1e-3;
    static constexpr int max_trust = 8, chance_every = 16;
    geometry::Matrix6 extra_{};
    int trust_ = max_trust / 2;
    unsigned passed_over_ = 0;
};

}  // namespace tactus::coupling
