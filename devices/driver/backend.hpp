// SPDX-License-Identifier: Apache-2.0
// The part of a real device's driver that differs between devices. ThreadedDevice does everything else (threads,
// watchdogs, limits, reconnection). Every method is called by one thread of the driver and may block.
#pragma once

#include "devices/driver/exchange.hpp"
#include "graph/node/device.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tactus::driver {

/// Properties of a device that are available without opening it.
struct Outline {
    DeviceInfo info;
    std::string absence;  ///< reason why the device cannot be present; empty: it may be
};

/// A device that is open.
struct Opened {
    DeviceInfo info;  ///< a device without motors exerts no force and needs no confirmation
    std::string serial;    ///< for messages, and for the confirmation of this device; empty: unknown
    std::string setup;     ///< settings that determine the direction of a push; part of the confirmation
    std::vector<std::string> versions;  ///< "SDK 3.17.5", for reports
    int axes = 3;            ///< directions in which it pushes: 1: right; 2: also away; 3: also up
};

enum class OpenMode {
    run,      ///< forces are enabled when the device is calibrated
    reading,  ///< nothing is enabled and nothing moves
};

/// Called with each step before it starts: "load libdhd.so". The last step is the one that failed.
using StepLog = std::function<void(const std::string& step)>;

class Backend {
public:
    virtual ~Backend() = default;

    virtual Outline outline() const = 0;

    /// Opens the device, at first and after a loss. Throws Error that states the failure and its remedy.
    virtual Opened open(OpenMode mode, const std::shared_ptr<Exchange>& exchange, const StepLog& step) = 0;

    /// Sends the force and publishes a sample, or checks the vendor's thread that does so. Returns false if the device
    /// is lost.
    virtual bool round(Exchange& exchange) noexcept = 0;

    /// Closes everything that is open: first removes the force. Also called after an `open` that threw.
    virtual void close() noexcept = 0;

    /// Time from one round to the next.
    virtual std::int64_t round_ns() const noexcept { return 500'000; }

    /// True if an external sender determines the amount of input, as at a socket or a line. The thread then runs with a
    /// priority below every tick, so that a flood of input delays no tick.
    virtual bool is_peer() const noexcept { return false; }
};

}  // namespace tactus::driver
