// SPDX-License-Identifier: Apache-2.0
// How late this machine makes a thread that only sleeps, beside what a test measures: a limit on the time of a test in real
// time holds for the program, not for what other programs do to it.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace tactus::test {

class LatenessControl {
public:
    LatenessControl()
        : thread_([this] {
              using std::chrono::steady_clock;
              constexpr auto step = std::chrono::milliseconds(1);
              for (auto due = steady_clock::now() + step; !ends_; due = steady_clock::now() + step) {
                  std::this_thread::sleep_until(due);
                  const std::int64_t late = std::chrono::nanoseconds(steady_clock::now() - due).count();
                  longest_ns_ = std::max(longest_ns_.load(), late);
              }
          }) {}
    ~LatenessControl() {
        ends_ = true;
        thread_.join();
    }
    LatenessControl(const LatenessControl&) = delete;
    LatenessControl& operator=(const LatenessControl&) = delete;

    /// Longest oversleep since the beginning, ns.
    std::int64_t longest_ns() const { return longest_ns_; }

private:
    std::atomic<bool> ends_{false};
    std::atomic<std::int64_t> longest_ns_{0};
    std::thread thread_;
};

}  // namespace tactus::test
