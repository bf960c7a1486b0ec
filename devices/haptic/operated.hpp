// SPDX-License-Identifier: Apache-2.0
// Base of all simulated devices: a simulated hand that holds the device and yields to its force.
#pragma once

#include "dsp/simulate/device_model.hpp"
#include "dsp/simulate/hand.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <atomic>
#include <optional>
#include <utility>

namespace tactus::haptic {

/// Reads the options of the hand and the device: grip, mass, inertia, stiffness, damping, angular_stiffness,
/// angular_damping, max_force, max_torque, max_stiffness, torque (false: a device without torque, with three degrees of
/// freedom), and model, a simulated commercial device. With a model, mass and inertia are those of the hand alone.
simulate::HandDynamics read_hand(Options& options);
DeviceInfo read_device_info(Options& options, const simulate::HandDynamics& hand, std::string name);
/// Reads the option `model`; null: an ideal device.
const simulate::DeviceModel* read_model(Options& options);

/// Describes a hand that a person moves by an input device without motors, whose friction, resolution and delay are not
/// simulated. Its grip gets the strength `max_force`. Throws Error if a model is given.
DeviceInfo read_info_without_motors(Options& options, simulate::HandDynamics& hand, std::string name);

/// Longest motion of such a hand in one tick of `period` s, in s. No force stops it while ticks are late, so without
/// this limit it would sink into a body that it presses.
double max_tick_of_hand(double period) noexcept;

/// The last commanded force. A watchdog may set it while the device is read.
class SharedWrench {
    static_assert(std::atomic<double>::is_always_lock_free);

public:
    /// Wait-free for one writer.
    void set(const Wrench& w) noexcept {
        const double all[6] = {w.force.x, w.force.y, w.force.z, w.torque.x, w.torque.y, w.torque.z};
        for (int i = 0; i < 6; ++i) parts_[i].store(all[i], std::memory_order_relaxed);
    }
    /// Wait-free. During a concurrent write some components may be old.
    Wrench get() const noexcept {
        double all[6];
        for (int i = 0; i < 6; ++i) all[i] = parts_[i].load(std::memory_order_relaxed);
        return {{all[0], all[1], all[2]}, {all[3], all[4], all[5]}};
    }

private:
    std::atomic<double> parts_[6] = {};
};

/// A device in a simulated hand. `Operator` gives the intended motion: it needs the call operator for `advance` in
/// dsp/simulate/hand.hpp, `start()` and `buttons()`.
template <typename Operator>
class OperatedDevice final : public HapticDevice {
public:
    /// Without a model the device is ideal: no friction, infinite resolution, no delay.
    OperatedDevice(DeviceInfo info, const simulate::HandDynamics& dynamics, Operator initial,
                   const simulate::DeviceModel* model = nullptr)
        : info_(std::move(info)), initial_(std::move(initial)), operator_(initial_) {
        hand_.dynamics = dynamics;
        hand_.pose = operator_.start();
        if (model) modelled_.emplace(*model, dynamics);
    }

    const DeviceInfo& info() const override { return info_; }

    void prepare(double) override {
        operator_ = initial_;
        hand_.pose = operator_.start();
        hand_.twist = {};
        if (modelled_) modelled_->place(operator_.start());
        force_.set({});
        counter_ = 0;
    }

    DeviceSample acquire(double elapsed_s) noexcept override {
        if (modelled_) {
            modelled_->advance(operator_, force_.get(), elapsed_s);
            return {modelled_->pose(), modelled_->twist(), operator_.buttons(), ++counter_,
                    is_good(modelled_->pose(), modelled_->twist())};
        }
        simulate::advance(hand_, operator_, force_.get(), elapsed_s);
        return {hand_.pose, hand_.twist, operator_.buttons(), ++counter_, is_good(hand_.pose, hand_.twist)};
    }

    void commit(const Wrench& on_hand) noexcept override { force_.set(on_hand); }

private:
    DeviceInfo info_;
    Operator initial_, operator_;
    simulate::Hand hand_;
    std::optional<simulate::ModelledDevice> modelled_;
    SharedWrench force_;
    std::int64_t counter_ = 0;
};

}  // namespace tactus::haptic
