// SPDX-License-Identifier: Apache-2.0
// The process of a device, managed by the engine.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>

namespace tactus::hosted {

/// Returns the program that runs drivers: $TACTUS_DEVICE_HOST, otherwise the one beside this program, otherwise the
/// installed one. Throws Error if there is none.
std::filesystem::path host_program();

/// Runs in its own session, so that no key of the terminal reaches it, and inherits only the given descriptors. No
/// function waits for it without a limit.
class HostProcess {
public:
    /// `block` and `socket` become descriptors 3 and 4. Throws Error.
    HostProcess(const std::filesystem::path& program, int block, int socket);
    /// Kills it if it runs.
    ~HostProcess();
    HostProcess(const HostProcess&) = delete;
    HostProcess& operator=(const HostProcess&) = delete;

    /// True if it has ended and was reaped. Does not wait.
    bool has_ended() noexcept;
    /// Waits for its end, at most `longest`.
    bool wait(std::chrono::milliseconds longest) noexcept;
    void kill() noexcept;
    /// Returns "was killed by signal 9" or "ended with exit code 3"; after `has_ended`.
    std::string how_it_ended() const;
    pid_t id() const noexcept { return process_; }

private:
    pid_t process_ = -1;
    int handle_ = -1;  // pidfd
    int status_ = 0;
    bool has_ended_ = false, is_known_ = true;
};

inline constexpr int block_descriptor = 3, socket_descriptor = 4;

}  // namespace tactus::hosted
