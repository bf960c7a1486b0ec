// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/host_process.hpp"

#include "assets/file/part.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <utility>
#include <vector>

extern char** environ;

namespace tactus::hosted {

namespace fs = std::filesystem;

namespace {

/// Processes that were killed, but that the system had not ended yet: a driver inside the kernel may keep one.
class Unreaped {
public:
    void add(pid_t process) {
        const std::lock_guard lock(lock_);
        processes_.push_back(process);
    }
    void reap() {
        const std::lock_guard lock(lock_);
        std::erase_if(processes_, [](pid_t process) { return ::waitpid(process, nullptr, WNOHANG) != 0; });
    }

private:
    std::mutex lock_;
    std::vector<pid_t> processes_;
};

Unreaped& unreaped() {
    static Unreaped all;
    return all;
}

/// A copy of a descriptor out of the way of those that the new process gets.
class HighDescriptor {
public:
    explicit HighDescriptor(int of) : number(::fcntl(of, F_DUPFD_CLOEXEC, 10)) {}
    ~HighDescriptor() {
        if (number >= 0) ::close(number);
    }
    HighDescriptor(const HighDescriptor&) = delete;
    HighDescriptor& operator=(const HighDescriptor&) = delete;
    const int number;
};

struct Attributes {
    Attributes() {
        ::posix_spawnattr_init(&attributes);
        ::posix_spawn_file_actions_init(&actions);
        sigset_t none, all;
        ::sigemptyset(&none);
        ::sigfillset(&all);
        ::posix_spawnattr_setsigmask(&attributes, &none);
        ::posix_spawnattr_setsigdefault(&attributes, &all);
        // A thread of the engine may be in real time; the process decides for itself.
        const sched_param normal{};
        ::posix_spawnattr_setschedpolicy(&attributes, SCHED_OTHER);
        ::posix_spawnattr_setschedparam(&attributes, &normal);
        ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                                    POSIX_SPAWN_SETSCHEDULER);
    }
    ~Attributes() {
        ::posix_spawn_file_actions_destroy(&actions);
        ::posix_spawnattr_destroy(&attributes);
    }
    Attributes(const Attributes&) = delete;
    Attributes& operator=(const Attributes&) = delete;

    posix_spawnattr_t attributes;
    posix_spawn_file_actions_t actions;
};

}  // namespace

fs::path host_program() {
    if (const char* given = std::getenv("TACTUS_DEVICE_HOST"); given && *given) return given;
    return file::find_part("the program that runs drivers", "tactus-device-host", TACTUS_INSTALLED_PROGRAMS);
}

HostProcess::HostProcess(const fs::path& program, int block, int socket) {
    unreaped().reap();
    const HighDescriptor high_block(block), high_socket(socket);
    Attributes with;
    // What a driver prints goes to standard error: standard output is the command's.
    ::posix_spawn_file_actions_addopen(&with.actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&with.actions, 2, 1);
    ::posix_spawn_file_actions_adddup2(&with.actions, high_block.number, block_descriptor);
    ::posix_spawn_file_actions_adddup2(&with.actions, high_socket.number, socket_descriptor);
    ::posix_spawn_file_actions_addclosefrom_np(&with.actions, socket_descriptor + 1);
    std::string name = program.string();
    std::array<char*, 2> arguments{name.data(), nullptr};
    const int failure =
        ::posix_spawn(&process_, name.c_str(), &with.actions, &with.attributes, arguments.data(), environ);
    if (failure != 0)
        throw Error(fmt::format("{}: a process for a device cannot be started: {}", name, std::strerror(failure)));
    handle_ = static_cast<int>(::syscall(SYS_pidfd_open, process_, 0));
}

HostProcess::~HostProcess() {
    if (!has_ended()) {
        kill();
        if (!wait(std::chrono::milliseconds(50))) unreaped().add(process_);
    }
    if (handle_ >= 0) ::close(handle_);
}

bool HostProcess::has_ended() noexcept {
    if (has_ended_) return true;
    const pid_t ended = ::waitpid(process_, &status_, WNOHANG);
    // Somebody else may have waited for all children.
    is_known_ = ended == process_;
    has_ended_ = is_known_ || (ended < 0 && errno == ECHILD);
    return has_ended_;
}

bool HostProcess::wait(std::chrono::milliseconds longest) noexcept {
    const std::int64_t until = steady_ns() + std::chrono::nanoseconds(longest).count();
    while (!has_ended()) {
        const int left = ms_until(until);
        if (left == 0) return false;
        pollfd ended{handle_, POLLIN, 0};
        if (handle_ >= 0) ::poll(&ended, 1, left);
        else sleep_for(1'000'000);
    }
    return true;
}

void HostProcess::kill() noexcept {
    if (!has_ended()) ::kill(process_, SIGKILL);
}

std::string HostProcess::how_it_ended() const {
    if (!is_known_) return "has ended";
    if (WIFSIGNALED(status_)) return fmt::format("was killed by signal {}", WTERMSIG(status_));
    return fmt::format("ended with exit code {}", WEXITSTATUS(status_));
}

}  // namespace tactus::hosted
