// SPDX-License-Identifier: Apache-2.0
// Velocity from quantised positions by an adaptive window.
#pragma once

#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>

namespace tactus::control {

/// First-order adaptive window with an end fit: F. Janabi-Sharifi, V. Hayward, C.-S. J. Chen, "Discrete-time adaptive
/// windowing for velocity estimation", IEEE Trans. Control Systems Technology 8 (2000), section III. The velocity is
/// the slope between the newest sample and the oldest one for which the line between them is within `noise` of every
/// sample between: a long window, and little noise, while the motion is slow or steady, a short one and little lag
/// while it changes.
class AdaptiveWindow {
public:
    static constexpr std::size_t longest = 16;  ///< samples

    /// `noise` in m (or rad): most that a sample is away from the truth.
    void prepare(double noise) noexcept {
        *this = AdaptiveWindow{};
        noise_ = noise;
    }

    /// Takes a sample `elapsed_s` after the one before; returns the velocity per second. Real-time safe.
    Vec3 operator()(const Vec3& sample, double elapsed_s) noexcept {
        for (std::size_t i = std::min(count_, longest - 1); i > 0; --i) {
            samples_[i] = samples_[i - 1];
            ages_[i] = ages_[i - 1] + elapsed_s;
        }
        samples_[0] = sample;
        ages_[0] = 0.0;
        count_ = std::min(count_ + 1, longest);
        Vec3 velocity(0.0);
        window_ = 0;
        for (std::size_t n = 1; n < count_; ++n) {
            if (!(ages_[n] > 0.0)) continue;
            const Vec3 slope = (samples_[0] - samples_[n]) / ages_[n];
            if (n > 1 && !fits(slope, n)) break;
            velocity = slope;
            window_ = n;
        }
        return velocity;
    }

    /// Samples back to which the last velocity reaches.
    std::size_t window() const noexcept { return window_; }

private:
    bool fits(const Vec3& slope, std::size_t n) const noexcept {
        for (std::size_t i = 1; i < n; ++i) {
            const Vec3 off = samples_[0] - slope * ages_[i] - samples_[i];
            if (glm::dot(off, off) > noise_ * noise_) return false;
        }
        return true;
    }

    std::array<Vec3, longest> samples_{};
    std::array<double, longest> ages_{};
    std::size_t count_ = 0, window_ = 0;
    double noise_ = 0.0;
};

}  // namespace tactus::control
