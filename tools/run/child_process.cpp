// SPDX-License-Identifier: Apache-2.0
#include "tools/run/child_process.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

namespace tactus::run {

namespace {

constexpr std::size_t max_output = 256 << 20;  // bytes

[[noreturn]] void become(char* const* argv, const std::filesystem::path& folder, const Capture& out, const Capture& err,
                         pid_t parent, bool has_group) {
    if (has_group) ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    std::signal(SIGPIPE, SIG_DFL);  // ignored here; a program expects what a shell gives it
    if (const int null = ::open("/dev/null", O_RDONLY | O_CLOEXEC); null >= 0) ::dup2(null, STDIN_FILENO);
    ::dup2(out.handle(), STDOUT_FILENO);
    ::dup2(err.handle(), STDERR_FILENO);
    if (folder.empty() || ::chdir(folder.c_str()) == 0) ::execvp(argv[0], argv);
    // Between fork and exec nothing may allocate: another thread may have held the lock of the heap.
    for (const char* part : {static_cast<const char*>(argv[0]), ": cannot be run: ", ::strerrordesc_np(errno), "\n"})
        [[maybe_unused]]
        const ssize_t ignored = ::write(STDERR_FILENO, part, std::strlen(part));
    ::_exit(127);
}

}  // namespace

Capture::Capture(const char* name) : handle_(::memfd_create(name, MFD_CLOEXEC)) {
    if (handle_ < 0) throw Error(fmt::format("cannot capture output: {}", std::strerror(errno)));
}

Capture::~Capture() { ::close(handle_); }

std::string Capture::text() const {
    const off_t size = ::lseek(handle_, 0, SEEK_END);
    if (size < 0 || static_cast<std::size_t>(size) > max_output)
        throw Error(fmt::format("the program wrote {} MB; the limit is {} MB", size >> 20, max_output >> 20));
    std::string text(static_cast<std::size_t>(size), '\0');
    std::size_t got = 0;
    while (got < text.size()) {
        const ssize_t count = ::pread(handle_, text.data() + got, text.size() - got, static_cast<off_t>(got));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        got += static_cast<std::size_t>(count);
    }
    text.resize(got);
    return text;
}

Finished run_process(const std::vector<std::string>& words, const std::filesystem::path& folder, const Capture& out,
                     const Capture& err, const ProcessLimits& limits) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    const bool is_watched = limits.seconds > 0.0 || limits.stop;
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child < 0) throw Error(fmt::format("cannot start a process: {}", std::strerror(errno)));
    if (child == 0) become(argv.data(), folder, out, err, parent, is_watched);
    Finished finished;
    int status = 0;
    rusage usage{};
    if (is_watched) {
        ::setpgid(child, child);
        const auto begin = std::chrono::steady_clock::now();
        auto pause = std::chrono::microseconds(200);
        for (bool is_killed = false;;) {
            const pid_t ended = ::wait4(child, &status, WNOHANG, &usage);
            if (ended != 0 && !(ended < 0 && errno == EINTR)) break;
            const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            finished.is_late = finished.is_late || (limits.seconds > 0.0 && elapsed > limits.seconds);
            if (!is_killed && (finished.is_late || (limits.stop && *limits.stop))) {
                is_killed = true;
                ::kill(-child, SIGKILL);
                ::kill(child, SIGKILL);
            }
            std::this_thread::sleep_for(pause);
            pause = std::min(2 * pause, std::chrono::microseconds(20'000));
        }
    } else {
        while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
        }
    }
    const auto seconds_of = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    finished.peak = static_cast<double>(usage.ru_maxrss) * 1024.0;
    finished.seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
    finished.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    finished.code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    return finished;
}

}  // namespace tactus::run
