// SPDX-License-Identifier: Apache-2.0
// Whether this machine wakes threads in time, seen beside a test in real time.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

namespace tactus::test {

/// A thread that only sleeps: it asks to be woken every millisecond, above every thread of the engine where the system
/// allows that, and counts how often that came a millisecond late or more. No work of ours can make it late then.
class MachineWatch {
public:
    MachineWatch();
    ~MachineWatch();
    MachineWatch(const MachineWatch&) = delete;
    MachineWatch& operator=(const MachineWatch&) = delete;

    std::int64_t late() const { return late_; }
    /// Whether that can be why a test failed. One of a window waits for pictures: only what is longer than one delays it.
    bool excuses(bool shows_window) const { return late_ > 0 && (!shows_window || worst_ns_ > picture_ns); }
    /// "woke a thread that does nothing late 3 times in 2.0 s, at worst by 12.5 ms".
    std::string text() const;

private:
    static constexpr std::int64_t picture_ns = 16'667'000;
    void watch();

    std::atomic<bool> is_over_ = false;
    std::atomic<std::int64_t> late_ = 0, wakes_ = 0, worst_ns_ = 0;
    std::thread thread_;
};

}  // namespace tactus::test
