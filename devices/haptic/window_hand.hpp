// SPDX-License-Identifier: Apache-2.0
// Exchange between a window and the driver 'mouse' in one process.
#pragma once

#include "devices/hosted/seqlock.hpp"
#include "dsp/core/types.hpp"

#include <atomic>
#include <cstdint>

namespace tactus::haptic {

/// Target pose from the window, device frame. Sent once per frame, also while the mouse rests.
struct WantedHand {
    Pose pose;
    std::int64_t buttons = 0;     ///< bits of DeviceSample::buttons
    std::int64_t at_ns = 0;       ///< steady clock
    std::int64_t picture_ns = 0;  ///< duration of the previous frame, over which the hand moves here
    std::int64_t run = 0;         ///< FeltHand::run for which it is meant; others are ignored
};

/// Pose of the driver's hand and the force on it, device frame.
struct FeltHand {
    Pose pose;
    Wrench force;
    std::int64_t run = 0;     ///< increases when a run begins; 0: no device was opened yet
    std::int64_t at_ns = 0;   ///< steady clock
    std::int64_t is_silent = 0;  ///< the window was silent for too long: the force fades
};

/// Wait-free on both sides. The window writes `wanted`, the thread of the device's ticks writes `felt`.
struct WindowHand {
    hosted::Seqlock<WantedHand> wanted;
    hosted::Seqlock<FeltHand> felt;
    std::atomic<int> windows{0};  ///< number of open windows
    std::atomic<int> devices{0};  ///< number of devices that it moves; at most one
};

/// The instance of this process.
WindowHand& window_hand() noexcept;

}  // namespace tactus::haptic
