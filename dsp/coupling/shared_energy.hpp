// SPDX-License-Identifier: Apache-2.0
// Energy that passes from one hand to another through a coupling that is meant to pass it on.
#pragma once

#include "dsp/core/rotation.hpp"
#include "dsp/core/types.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace tactus::coupling {

/// The energy cap of each hand counts what that hand has put in, so that a hand which is led by the other one would get no
/// force. This account knows both: what the two have put in and not got back, at most what the coupling stores now, may
/// go to either of them, and what one puts in now may go to the other. Both come from the work of the wrenches that were held
/// since the last call; what a damper has dissipated, or what nobody put in, is granted to nobody.
class SharedEnergy {
public:
    static constexpr double window_s = 0.02;  ///< as control::EnergyCap::grant_window_s: unused power lapses after it

    /// One of the two hands: its pose, and the wrench on it until the next call.
    struct Hand {
        Pose pose;
        Wrench wrench;
    };
    using Grants = std::array<double, 2>;  ///< W, for each of the two hands

    /// `stored` J is the energy of the coupling at these poses. Real-time safe.
    Grants tick(const std::array<Hand, 2>& hands, double stored, double elapsed_s) noexcept {
        if (!(elapsed_s > 0.0) || !std::isfinite(stored) || !is_valid(hands[0].pose) || !is_valid(hands[1].pose) ||
            !is_finite(hands[0].wrench) || !is_finite(hands[1].wrench)) {
            *this = {};
            return {};
        }
        Grants grants{};
        std::array<double, 2> taken{};
        if (started_)
            for (std::size_t i = 0; i < 2; ++i) {
                taken[i] = -glm::dot(last_[i].wrench.force, hands[i].pose.position - last_[i].pose.position) -
                           glm::dot(last_[i].wrench.torque,
                                    rotation_between(last_[i].pose.orientation, hands[i].pose.orientation));
                const double share = std::min(1.0, elapsed_s / window_s);
                power_[i] += share * (taken[i] / elapsed_s - power_[i]);
            }
        energy_ = std::clamp(energy_ + taken[0] + taken[1], 0.0, std::max(0.0, stored));
        for (std::size_t i = 0; i < 2; ++i) grants[i] = std::max(0.0, power_[1 - i]) + energy_ / window_s;
        last_ = hands;
        started_ = true;
        return grants;
    }

    double energy() const noexcept { return energy_; }  ///< J, that either hand may get

private:
    std::array<Hand, 2> last_;
    std::array<double, 2> power_{};  // W, that each hand puts in, smoothed over the window
    double energy_ = 0.0;
    bool started_ = false;
};

}  // namespace tactus::coupling
