// SPDX-License-Identifier: Apache-2.0
#include "nodes/event/emitter.hpp"

namespace tactus::nodes {

struct ButtonEvents {
    static constexpr auto about =
        "An event when a button of a haptic device is pressed (begin) and when it is released (end); or when a bool "
        "becomes true and false.";

    In<bool> in{optional, "counts instead of a device's button"};
    Out<Event> events{"presses and releases"};
    Text device{"", "name of the device when the patch has several"};
    Param number{structural, "0", "0", "31", "which button of the device, from 0"};

    void prepare(const Setup& setup) {
        emit_.prepare(setup);
        was_ = false;
        port_ = in.connected ? nullptr : &setup.host->device(device.value, DeviceUse::read, setup.where);
    }
    void process(const Tick& tick) noexcept {
        // An edit may give a running node a wire, or take it away.
        const bool reads_device = port_ && !in.connected;
        if (reads_device && !port_->sample.valid) return;
        const bool is = reads_device ? (port_->sample.buttons >> static_cast<unsigned>(number)) & 1u : in.get();
        if (is != was_) emit_(events, tick, 0, is ? EventKind::begin : EventKind::end, {});
        was_ = is;
    }

private:
    Emitter emit_;
    DevicePort* port_ = nullptr;
    bool was_ = false;
};

TACTUS_NODE(ButtonEvents, in, events, device, number)

}  // namespace tactus::nodes
