// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/operated.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tactus::haptic {

simulate::HandDynamics read_hand(Options& options) {
    // What is not given follows from the grip.
    const simulate::HandDynamics grip = simulate::gripping(options.quantity("grip", "5 N", "0 N", "100 N"));
    const auto standard = [](double value, const char* unit) { return fmt::format("{} {}", value, unit); };
    simulate::HandDynamics hand;
    hand.mass = options.quantity("mass", "0.2 kg", "0.01 kg", "5 kg");
    hand.inertia = options.quantity("inertia", "4e-4 kg m^2", "1e-6 kg m^2", "1 kg m^2");
    hand.stiffness = options.quantity("stiffness", standard(grip.stiffness, "N/m"), "0 N/m", "20000 N/m");
    hand.damping = options.quantity("damping", standard(grip.damping, "N s/m"), "0 N s/m", "500 N s/m");
    hand.angular_stiffness =
        options.quantity("angular_stiffness", standard(grip.angular_stiffness, "N m/rad"), "0 N m/rad", "100 N m/rad");
    hand.angular_damping =
        options.quantity("angular_damping", standard(grip.angular_damping, "N m s/rad"), "0 N m s/rad", "5 N m s/rad");
    return hand;
}

const simulate::DeviceModel* read_model(Options& options) {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all{"ideal"};
        for (const simulate::DeviceModel& model : simulate::device_models()) all.emplace_back(model.name);
        return all;
    }();
    const std::size_t chosen = options.choice("model", names, "ideal");
    return chosen == 0 ? nullptr : &simulate::device_models()[chosen - 1];
}

DeviceInfo read_device_info(Options& options, const simulate::HandDynamics& hand, std::string name) {
    const simulate::DeviceModel* const model = read_model(options);
    const bool gives_torque = !model || model->max_torque > 0.0;
    DeviceInfo info;
    info.name = model ? fmt::format("{}, {}", name, model->about) : std::move(name);
    info.max_force =
        options.quantity("max_force", model ? fmt::format("{} N", model->max_force) : "20 N", "0.1 N", "200 N");
    info.max_torque = options.quantity("max_torque", "1 N m", "0.001 N m", "20 N m");
    info.damping = hand.damping;
    info.max_stiffness = options.quantity("max_stiffness", "0 N/mm", "0 N/mm", "100 N/mm");
    info.actuates_torque = options.flag("torque", gives_torque);
    info.senses_rotation = true;
    if (!model) return info;
    info.max_force = std::min(info.max_force, model->max_force);
    info.max_torque = std::min(info.max_torque, model->max_torque);
    info.damping = hand.damping + model->viscous;
    if (info.max_stiffness == 0.0) info.max_stiffness = model->max_stiffness;
    info.resolution = model->resolution;
    info.angular_resolution = model->angular_resolution;
    info.delay = model->delay;
    info.actuates_torque = info.actuates_torque && gives_torque;
    return info;
}

DeviceInfo read_info_without_motors(Options& options, simulate::HandDynamics& hand, std::string name) {
    if (read_model(options))
        throw Error(options.where("model"),
                    fmt::format("{}: a hand that a person moves has no 'model'; only 'simulated', 'scripted' and "
                                "'replay' simulate a device as it is",
                                options.owner()));
    DeviceInfo info = read_device_info(options, hand, std::move(name));
    info.without_motors = true;
    hand.strength = info.max_force;
    return info;
}

double max_tick_of_hand(double period) noexcept { return std::max(5e-3, 2.0 * period); }

}  // namespace tactus::haptic
