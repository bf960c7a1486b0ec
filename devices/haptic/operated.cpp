// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/operated.hpp"

namespace tactus::haptic {

simulate::HandDynamics read_hand(Options& options) {
    simulate::HandDynamics hand;
    hand.mass = options.quantity("mass", "0.2 kg", "0.01 kg", "5 kg");
    hand.inertia = options.quantity("inertia", "4e-4 kg m^2", "1e-6 kg m^2", "1 kg m^2");
    hand.stiffness = options.quantity("stiffness", "800 N/m", "0 N/m", "20000 N/m");
    hand.damping = options.quantity("damping", "15 N s/m", "0 N s/m", "500 N s/m");
    hand.angular_stiffness = options.quantity("angular_stiffness", "2 N m/rad", "0 N m/rad", "100 N m/rad");
    hand.angular_damping = options.quantity("angular_damping", "0.04 N m s/rad", "0 N m s/rad", "5 N m s/rad");
    return hand;
}

DeviceInfo read_device_info(Options& options, const simulate::HandDynamics& hand, std::string name) {
    DeviceInfo info;
    info.name = std::move(name);
    info.max_force = options.quantity("max_force", "20 N", "0.1 N", "200 N");
    info.max_torque = options.quantity("max_torque", "1 N m", "0.001 N m", "20 N m");
    info.damping = hand.damping;
    info.max_stiffness = 5000.0;  // typical specification of grounded desktop devices at 1 kHz
    info.actuates_torque = options.flag("torque", true);
    info.senses_rotation = true;
    return info;
}

}  // namespace tactus::haptic
