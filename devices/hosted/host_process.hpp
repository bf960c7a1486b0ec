// SPDX-License-Identifier: Apache-2.0
// A device's process, as the engine sees it.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>

namespace tactus::hosted {

/// The program that runs drivers: $TACTUS_DEVICE_HOST, or that beside this program, or the installed one. Throws Error
/// when it is not there.
std::filesystem::path host_program();

/// Started with a session of its own, so that no key of the terminal reaches it, without descriptors but those given.
/// Never waits for it without a bound.
class HostProcess {
public:
    /// `block` and `socket` become descriptors 3 and 4. Throws Error.
    HostProcess(const std::filesystem::path& program, int block, int socket);
    /// Kills it if it runs.
    ~HostProcess();
    HostProcess(const HostProcess&) = delete;
    HostProcess& operator=(const HostProcess&) = delete;

    /// It has ended, and nothing of it is left. Does not wait.
    bool has_ended() noexcept;
    /// Waits until it has ended, at most so long.
    bool wait(std::chrono::milliseconds longest) noexcept;
    void kill() noexcept;
    /// "was killed by signal 9", "ended with exit code 3"; after `has_ended`.
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
