// SPDX-License-Identifier: Apache-2.0
// What differs between drivers of real devices. All else (threads, watchdogs, limits, reconnection) is in
// ThreadedDevice. Every method is called by one thread of the driver's own and may block.
#pragma once

#include "devices/driver/exchange.hpp"
#include "graph/node/device.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tactus::driver {

/// What is known of a device without opening it.
struct Outline {
    DeviceInfo info;
    std::string absence;  ///< why it cannot be here; empty: it may be
};

/// A device that is open.
struct Opened {
    DeviceInfo info;  ///< one without motors cannot push anybody, and needs no confirmation
    std::string serial;    ///< for people, and for what was confirmed of this device; empty: it states none
    std::string setup;     ///< settings on which the direction of a push depends; part of what is confirmed
    std::vector<std::string> versions;  ///< "SDK 3.17.5", for reports
    int axes = 3;            ///< along which it pushes: 1: to the right; 2: and away; 3: and up
};

enum class OpenMode {
    run,      ///< forces are enabled when the device is calibrated
    reading,  ///< nothing is enabled and nothing moves
};

/// Called with each step before it is taken: "load libdhd.so". The last one is the one that failed.
using StepLog = std::function<void(const std::string& step)>;

class Backend {
public:
    virtual ~Backend() = default;

    virtual Outline outline() const = 0;

    /// Opens the device, at first and again when it was lost. Throws Error that says what failed and what to do.
    virtual Opened open(OpenMode mode, const std::shared_ptr<Exchange>& exchange, const StepLog& step) = 0;

    /// Gives the force and publishes a sample, or looks after a vendor's thread that does. False: the device is lost.
    virtual bool round(Exchange& exchange) noexcept = 0;

    /// Closes what is open: no force, then all else. Also after an `open` that threw.
    virtual void close() noexcept = 0;

    /// Time from one round to the next.
    virtual std::int64_t round_ns() const noexcept { return 500'000; }

    /// True when somebody else decides how much there is to read, as at a socket or a line: then the thread runs below
    /// every tick, so that a flood takes time from nobody.
    virtual bool is_peer() const noexcept { return false; }
};

}  // namespace tactus::driver
