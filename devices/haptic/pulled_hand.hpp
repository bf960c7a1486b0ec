// SPDX-License-Identifier: Apache-2.0
// The target pose of a hand that a spring pulls, as published by drivers for display in a window.
#pragma once

#include "devices/hosted/seqlock.hpp"
#include "dsp/core/types.hpp"

#include <cstdint>
#include <memory>

namespace tactus::haptic {

/// Device frame.
struct PulledHand {
    Pose pose, wanted;
    Wrench force;            ///< on the hand
    std::int64_t at_ns = 0;  ///< steady clock
};

/// Written by the thread that moves the hand, read by any thread; wait-free on both sides. Nothing is written if no
/// hand is pulled or while the device is lost.
using PullLink = hosted::Seqlock<PulledHand>;

/// A device that publishes its target pose. The link may outlive the device.
class PulledDevice {
public:
    virtual ~PulledDevice() = default;
    virtual std::shared_ptr<const PullLink> pull() const noexcept = 0;
};

}  // namespace tactus::haptic
