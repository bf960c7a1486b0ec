// SPDX-License-Identifier: Apache-2.0
// A free-flying device, held by no hand: it is thrown towards −z.
#pragma once

#include "dsp/simulate/device_model.hpp"
#include "graph/node/device.hpp"

#include <memory>

namespace tactus::analysis {

struct Throw {
    simulate::DeviceModel model;
    double mass = 0.3, speed = 0.2;  ///< kg of the hand, m/s at the start
    double height = 0.0;             ///< m above the origin at the start
    double at_s = 0.2;               ///< s, time of the throw; before, it is at rest
};

/// Result of the flight. Lives outside of the device, which is destroyed with its engine.
struct Flight {
    double before = 0.0;  ///< J, kinetic energy when the first force acted
    double after = 0.0;   ///< J, after the last force
    bool touched = false, left = false;
    double ratio() const { return before > 0.0 ? after / before : 0.0; }
};

std::unique_ptr<HapticDevice> open_thrown(const Throw& thrown, Flight& flight);

}  // namespace tactus::analysis
