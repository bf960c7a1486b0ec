// SPDX-License-Identifier: Apache-2.0
// Reads the states of a JACK server that PortAudio does not report.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::audio {

/// A second, silent client of the server that PortAudio uses. In freewheel mode the server does not run in real time
/// and waits for every client; only then may a callback wait.
class JackWatch {
public:
    /// Never throws; without a server it reports nothing.
    JackWatch() noexcept;
    /// Must not run when the server is gone, because libjack would wait for it. See `is_gone`.
    ~JackWatch();
    JackWatch(const JackWatch&) = delete;
    JackWatch& operator=(const JackWatch&) = delete;

    /// Names the ports "out_0", "out_1", … or "in_0", … of the stream that PortAudio opened last; "" keeps a name.
    /// Names that another port already has are skipped.
    void name_ports(const char* kind, const std::vector<std::string>& names) const;

    // Any thread; wait-free.
    bool freewheels() const noexcept { return freewheels_.load(std::memory_order_relaxed); }
    bool is_gone() const noexcept { return gone_.load(std::memory_order_relaxed); }

private:
    void* client_ = nullptr;
    std::atomic<bool> freewheels_{false}, gone_{false};
};

}  // namespace tactus::audio
