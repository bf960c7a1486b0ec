// SPDX-License-Identifier: Apache-2.0
// What the pictures of a window cost: processor time of the thread that draws, and of those on which Mesa's software
// renderer (llvmpipe) draws for it. Time that other programs take does not count.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <vector>

namespace tactus::window {

class PictureMeter {
public:
    struct Cost {
        double at = 0.0;  ///< s since the first picture that drew a scene; negative: before it
        double processor = 0.0;  ///< s, since the picture before
        bool draws_scene = false;  ///< false: only panels were drawn
    };

    /// After each picture, on the thread that draws. `scenes`: number of scenes drawn since the window opened.
    void add(std::int64_t scenes);
    const std::vector<Cost>& costs() const { return costs_; }
    /// Threads that draw, with that of the window.
    std::size_t threads() const { return spent_.size(); }

private:
    using Clock = std::chrono::steady_clock;
    /// s of all threads that draw, since the last call.
    double spend();

    std::map<pid_t, double> spent_;  ///< s, by thread
    std::map<pid_t, bool> draws_;  ///< every thread that was looked at
    std::int64_t scenes_ = 0;
    Clock::time_point first_{};
    std::vector<Cost> costs_;
};

}  // namespace tactus::window
