// SPDX-License-Identifier: Apache-2.0
// Says that the window is alive while it draws a picture. Without a graphics card one drawing call, or the wait for the
// screen, may take longer than the silence after which the driver 'mouse' lets go of the hand.
#pragma once

#include "devices/haptic/window_hand.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

namespace tactus::window {

/// A window that makes no progress with its picture for so long hangs. Nothing is said for it any more, so that the driver
/// lets go of the hand longest_silence_of_window_ns later. One step of a picture, such as the wait for all that was drawn,
/// takes up to half of it where one busy processor draws 1700 by 1100 pixels.
inline constexpr std::int64_t longest_step_ns = 1'000'000'000;

/// All calls but `repeat` on the thread of the window.
class HandPulse {
public:
    HandPulse(haptic::WindowHand& link, std::int64_t (*now_ns)()) : link_(link), now_ns_(now_ns) {}
    ~HandPulse();
    HandPulse(const HandPulse&) = delete;
    HandPulse& operator=(const HandPulse&) = delete;

    /// Tells the driver where the hand is wanted; within a picture this is progress.
    void say(const haptic::WantedHand& wanted);
    /// There is no hand to speak for.
    void forget();
    /// From here until `end_picture` the window draws, and may have no time to speak.
    void begin_picture();
    void end_picture();
    /// Says the last word again, if a picture is being drawn and makes progress. The own thread does so every 20 ms while
    /// there is a hand.
    void repeat();

private:
    void beat();

    haptic::WindowHand& link_;
    std::int64_t (*now_ns_)();
    std::mutex guard_;  // of all below, and of the one writer of the link
    std::condition_variable ends_;
    std::optional<haptic::WantedHand> last_;
    std::int64_t progress_ns_ = 0;
    bool draws_ = false, has_ended_ = false;
    std::thread thread_;
};

}  // namespace tactus::window
