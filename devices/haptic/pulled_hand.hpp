// SPDX-License-Identifier: Apache-2.0
// A hand that a spring pulls where a person wants it, as drivers tell of it: a window may look, and moves nothing.
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

/// The thread that moves the hand writes, anybody reads; wait-free on both sides. Nothing is written where no hand is
/// pulled, and while the device is lost.
using PullLink = hosted::Seqlock<PulledHand>;

/// A device that tells of it. The link may outlive the device.
class PulledDevice {
public:
    virtual ~PulledDevice() = default;
    virtual std::shared_ptr<const PullLink> pull() const noexcept = 0;
};

}  // namespace tactus::haptic
