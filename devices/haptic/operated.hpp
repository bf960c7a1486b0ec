// SPDX-License-Identifier: Apache-2.0
// What every simulated device shares: a hand on it that feels its force.
#pragma once

#include "dsp/operator/hand.hpp"
#include "graph/device.hpp"
#include "graph/options.hpp"

#include <utility>

namespace tactus {

/// Reads the options of the hand and of what the device can do: mass, inertia, stiffness, damping, angular_stiffness,
/// angular_damping, max_force, max_torque.
HandDynamics read_hand(Options& options);
DeviceInfo read_device_info(Options& options, const HandDynamics& hand, std::string name);

/// A device moved by a hand that `Operator` leads. Operator: the call of `advance` in dsp/operator/hand.hpp, `start()`
/// and `buttons()`.
template <typename Operator>
class OperatedDevice final : public HapticDevice {
public:
    OperatedDevice(DeviceInfo info, const HandDynamics& dynamics, Operator initial)
        : info_(std::move(info)), initial_(std::move(initial)), operator_(initial_) {
        hand_.dynamics = dynamics;
        hand_.pose = operator_.start();
    }

    const DeviceInfo& info() const override { return info_; }

    void prepare(double) override {
        operator_ = initial_;
        hand_.pose = operator_.start();
        hand_.twist = {};
        force_ = {};
        counter_ = 0;
    }

    DeviceSample acquire(double elapsed_s) noexcept override {
        advance(hand_, operator_, force_, elapsed_s);
        return {hand_.pose, hand_.twist, operator_.buttons(), ++counter_, is_valid(hand_.pose)};
    }

    void commit(const Wrench& on_hand) noexcept override { force_ = on_hand; }

private:
    DeviceInfo info_;
    Operator initial_, operator_;
    Hand hand_;
    Wrench force_;
    std::int64_t counter_ = 0;
};

}  // namespace tactus
