// SPDX-License-Identifier: Apache-2.0
// What PortAudio does not pass on of a JACK server.
#pragma once

#include <atomic>
#include <cstdint>

namespace tactus::audio {

/// A second, silent client of the server that PortAudio plays on. In freewheel the server does not keep time and waits
/// for every client: only then may a callback wait.
class JackWatch {
public:
    /// Never throws; without a server it sees nothing.
    JackWatch() noexcept;
    /// Must not run when the server is gone: libjack would wait for it. See `is_gone`.
    ~JackWatch();
    JackWatch(const JackWatch&) = delete;
    JackWatch& operator=(const JackWatch&) = delete;

    // Any thread; wait-free.
    bool freewheels() const noexcept { return freewheels_.load(std::memory_order_relaxed); }
    bool is_gone() const noexcept { return gone_.load(std::memory_order_relaxed); }

private:
    void* client_ = nullptr;
    std::atomic<bool> freewheels_{false}, gone_{false};
};

}  // namespace tactus::audio
