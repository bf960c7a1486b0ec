// SPDX-License-Identifier: Apache-2.0
#include "engine/io/lost_device.hpp"

#include "devices/hosted/hosted_device.hpp"

namespace tactus::io {

std::string service_device(DeviceSlot& slot) {
    auto* const device = dynamic_cast<hosted::HostedDevice*>(slot.device.get());
    return device ? device->service() : std::string();
}

std::string loss_of(const DeviceSlot& slot) {
    const auto* const device = dynamic_cast<const hosted::HostedDevice*>(slot.device.get());
    return device ? device->loss() : std::string();
}

}  // namespace tactus::io
