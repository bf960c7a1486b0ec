// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/saw/device_trial.hpp"

#include "dsp/core/error.hpp"
#include "dsp/simulate/device_model.hpp"
#include "dsp/simulate/hand.hpp"
#include "tools/analysis/saw/saw_trial.hpp"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

namespace tactus::analysis {

namespace {

constexpr double device_tick = 1e-3, device_carve_rate = 60.0;  // s, Hz

/// A hand that pushes down with a force and holds still across it.
struct Pushing {
    double force = 0.0, stiffness = 0.0;  // N, N/m of the grip

    simulate::Intention operator()(double, const Wrench&, const Pose& hand) const noexcept {
        return {{{0.0, 0.0, hand.position.z - force / stiffness},
                 glm::angleAxis(-0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0))},
                {}};
    }
};

/// The hand on the device, or on an ideal one.
class HeldDevice {
public:
    HeldDevice(std::string_view model, const simulate::HandDynamics& dynamics, const Pose& start) {
        hand_.dynamics = dynamics;
        hand_.pose = start;
        if (model == "ideal") return;
        const simulate::DeviceModel* const found = simulate::find_device_model(model);
        if (!found) throw Error(fmt::format("there is no device model '{}'", model));
        max_force_ = found->max_force;
        modelled_.emplace(*found, dynamics);
        modelled_->place(start);
    }

    Pose move(Pushing& push, const Wrench& on_hand) {
        if (modelled_) {
            modelled_->advance(push, on_hand, device_tick);
            return modelled_->pose();
        }
        simulate::advance(hand_, push, on_hand, device_tick);
        return hand_.pose;
    }
    /// What the device is given of a force.
    Vec3 given(const Vec3& asked) const {
        const double length = glm::length(asked);
        return length > max_force_ ? asked * (max_force_ / length) : asked;
    }

private:
    simulate::Hand hand_;
    std::optional<simulate::ModelledDevice> modelled_;
    double max_force_ = HUGE_VAL;
};

}  // namespace

DeviceTrialResult run_device_trial(const DeviceTrial& trial) {
    const SawTrial block{.depth = 0.025};
    const auto bone = saw_block(block);
    carve::Carver carver;
    carver.prepare(*bone, carve_settings_for(block.shape));
    saw::SawBlade blade(block.shape, trial.stiffness);
    const saw::CuttingLaw law;
    simulate::HandDynamics grip;
    grip.stiffness = 2000.0;
    grip.damping = 30.0;
    Pushing push{trial.thrust * trial.scale, grip.stiffness};
    const Pose start{{0.0, 0.0, 0.3e-3}, glm::angleAxis(-0.5 * std::numbers::pi, Vec3(1.0, 0.0, 0.0))};
    HeldDevice device(trial.model, grip, start);
    volume::BoneSnapshot read = bone->current();
    std::vector<carve::CutFront> path;
    Wrench given;
    double share = 1.0, before = 0.0, measured = 0.0, above = 0.0;
    std::int64_t carved = 0;
    DeviceTrialResult result;
    const auto settle = static_cast<std::int64_t>(trial.settle / device_tick);
    const auto ticks = settle + static_cast<std::int64_t>(trial.seconds / device_tick);
    for (std::int64_t n = 0; n < ticks; ++n) {
        if (n == settle) before = carver.removed_m3();
        const Pose pose = device.move(push, given);
        saw::Drive drive{true, block.blade_rate, device_tick};
        drive.rendered = share;
        const saw::SawContact now = blade.step(read, pose, drive, law);
        blade.teeth().fill(path.emplace_back(), pose, true);
        const Vec3 asked = now.wrench.force * trial.scale;
        given.force = device.given(asked);
        const double square = glm::dot(asked, asked);
        share = square > 0.0 ? std::clamp(glm::dot(given.force, asked) / square, 0.0, 1.0) : 1.0;
        if (n >= settle) {
            const double thrust = now.thrust * share,
                         rubbing = law.rub * now.teeth * block.density / law.reference_density;
            result.thrust += thrust;
            result.rubbing += rubbing;
            above += std::max(thrust - rubbing, 0.0) * device_tick;
            result.limited += share < 0.99;
            measured += 1.0;
        }
        if (static_cast<double>(n + 1) * device_carve_rate * device_tick >= static_cast<double>(carved + 1)) {
            ++carved;
            read = bone->publish();
            bone->reclaim(read.version);
            carver.update(*bone, path);
            path.clear();
        }
    }
    const double removed = carver.removed_m3() - before;
    result.thrust /= measured;
    result.rubbing /= measured;
    result.limited /= measured;
    result.removal = removed / trial.seconds;
    result.per_thrust = above > 0.0 ? removed / above : 0.0;
    return result;
}

std::span<const DeviceTrial> device_trials() noexcept {
    static constexpr DeviceTrial trials[] = {
        {.model = "ideal"},
        {.model = "omega", .scale = 1.0, .stiffness = 10e3},
        {.model = "falcon", .scale = 0.7, .stiffness = 4e3},
        {.model = "touch", .scale = 0.25, .stiffness = 4e3},
    };
    return trials;
}

}  // namespace tactus::analysis
