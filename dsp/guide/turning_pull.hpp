// SPDX-License-Identifier: Apache-2.0
// The pull to the nearest place of a shape, which turns in a bounded time where another part of the shape becomes the
// nearest.
//
// Where the nearest place jumps, the old one stays as a point that pulls by the same law, with a share that falls to 0.
// The energy is then the mean of those of all points by their shares. No point is nearer than the nearest place, so a
// share that goes over to it takes energy from the whole, and gives the hand none, whatever the hand does meanwhile. The
// damping is a mean of damping matrices, each of which only takes.
#pragma once

#include "dsp/guide/guide_law.hpp"

#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactus::guide {

class TurningPull {
public:
    static constexpr double turn_s = 0.05;  ///< in which a pull goes over to another place
    static constexpr double damping_s = 0.01;  ///< time constant of the damped directions
    static constexpr double hysteresis = 0.1e-3;  ///< m, by which another place must be nearer
    static constexpr double still = 1e-6;  ///< m: a nearest place that moves less does not jump, nor does its pull

    /// The next hand is another one: nothing turns to it.
    void reset() noexcept { *this = {}; }

    /// On a hand at `p` with this velocity, from the nearest place and the direction of the shape there, in which the
    /// hand is not damped; `dt` since the last call. m, m/s, s; N.
    Vec3 on(const GuideLaw& law, const Vec3& p, const Vec3& velocity, const Vec3& nearest, const Vec3& tangent,
            double dt) noexcept {
        const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(tangent, tangent);
        if (!is_known_) damped_ = across;
        else damped_ += (across - damped_) * (1.0 - std::exp(-dt / damping_s));
        fade(dt);
        // Of two places that are as near the hand keeps its own: rounding does not send it to and fro.
        Vec3 aim = nearest;
        if (is_known_ && glm::distance(nearest, nearest_) > 1.5 * glm::distance(p, p_) + still) {
            if (glm::distance(p, nearest_) - glm::distance(p, nearest) < hysteresis) aim = nearest_;
            else leave(nearest_);
        }
        is_known_ = true;
        nearest_ = aim;
        p_ = p;

        double share = 1.0;
        Vec3 spring(0.0);
        for (std::size_t i = 0; i < count_; ++i) {
            spring += left_[i].share() * law.spring_to(left_[i].at - p);
            share -= left_[i].share();
        }
        spring += std::max(share, 0.0) * law.spring_to(aim - p);
        const double grip = law.grip(glm::distance(aim, p));
        return limited_sum(spring, damped_ * velocity * (-law.damping * grip), law.max_force);
    }

private:
    struct Left {
        Vec3 at{0.0};
        double whole = 0.0;  ///< share in the beginning
        double time = 0.0;  ///< s until it is 0
        double share() const noexcept { return whole * time / turn_s; }
    };

    void fade(double dt) noexcept {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            left_[i].time -= dt;
            if (left_[i].time > 0.0) left_[kept++] = left_[i];
        }
        count_ = kept;
    }
    void leave(const Vec3& at) noexcept {
        double share = 1.0;
        for (std::size_t i = 0; i < count_; ++i) share -= left_[i].share();
        if (!(share > 0.0)) return;
        // The least gives its share to the nearest place.
        if (count_ == left_.size()) *std::ranges::min_element(left_, {}, &Left::share) = left_[--count_];
        left_[count_++] = {at, share, turn_s};
    }

    std::array<Left, 64> left_{};  // a fast hand between two places turns so often in turn_s
    std::size_t count_ = 0;
    glm::dmat3 damped_{1.0};
    Vec3 nearest_{0.0}, p_{0.0};
    bool is_known_ = false;
};

}  // namespace tactus::guide
