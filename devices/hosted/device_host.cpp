// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/device_host.hpp"

#include "devices/driver/threaded_device.hpp"
#include "devices/hosted/driver_loop.hpp"
#include "devices/hosted/host_process.hpp"
#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <thread>

namespace tactus::hosted {

namespace {

constexpr std::int64_t longest_silence_ns = 1'000'000'000;
constexpr std::int64_t longest_farewell_ns = 500'000'000;
constexpr int look_every_ms = 5;

/// Looks after the thread of the driver, which may never return from it.
class Supervisor {
public:
    explicit Supervisor(Block& block) : block_(block), loop_(block, socket_descriptor) {
        sigset_t ends;
        ::sigemptyset(&ends);
        for (const int signal : {SIGTERM, SIGINT, SIGHUP}) ::sigaddset(&ends, signal);
        ::pthread_sigmask(SIG_BLOCK, &ends, nullptr);
        signals_ = ::signalfd(-1, &ends, SFD_CLOEXEC);
        engine_ = static_cast<int>(::syscall(SYS_pidfd_open, static_cast<pid_t>(block.engine), 0));
        thread_ = std::thread([this] { loop_.run(); });
    }

    int run() noexcept {
        const std::string reason = wait_for_end();
        loop_.end();
        const std::int64_t give_up = steady_ns() + longest_farewell_ns;
        while (!loop_.is_over() && steady_ns() < give_up) sleep_for(1'000'000);
        tell(reason);
        // Neither joined nor unwound: who does not return from a driver never will.
        if (!loop_.is_over() || driver::abandoned_threads() > 0) ::_exit(3);
        thread_.join();
        return loop_.has_failed() ? 2 : 0;
    }

private:
    std::string wait_for_end() noexcept {
        for (;;) {
            pollfd all[3] = {{socket_descriptor, 0, 0}, {signals_, POLLIN, 0}, {engine_, POLLIN, 0}};
            ::poll(all, 3, look_every_ms);
            if (all[1].revents != 0) return "it got a signal to end";
            if (all[0].revents != 0 || all[2].revents != 0) return "the engine has ended";
            if (block_.must_end.load(std::memory_order_acquire) != 0) return "the engine is done";
            if (is_engine_silent()) return "the engine was silent for a second";
            if (loop_.is_over()) return "the driver gave up";
        }
    }

    /// True if neither the control thread nor a tick of the engine showed a sign of life.
    bool is_engine_silent() const noexcept {
        const std::int64_t said = block_.engine_lives_ns.load(std::memory_order_acquire);
        return said != 0 && steady_ns() - std::max(said, loop_.heard_ns()) > longest_silence_ns;
    }

    void tell(const std::string& reason) noexcept {
        std::memcpy(block_.reason, reason.data(), std::min(reason.size(), sizeof block_.reason - 1));
        block_.state.store(HostState::ended, std::memory_order_release);
    }

    Block& block_;
    DriverLoop loop_;
    int signals_ = -1, engine_ = -1;
    std::thread thread_;
};

}  // namespace

int run_device_host() noexcept {
    try {
        ::signal(SIGPIPE, SIG_IGN);
        // Before any thread: vendors' libraries ask for the user's language and then misread their own files.
        ::setenv("LC_ALL", "C", 1);
        std::setlocale(LC_ALL, "C");
        if (::fcntl(socket_descriptor, F_SETFD, FD_CLOEXEC) != 0 || ::fcntl(block_descriptor, F_SETFD, FD_CLOEXEC) != 0)
            throw Error("this program runs a driver for tactus, which starts it by itself");
        SharedBlock block = SharedBlock::open(block_descriptor);
        const int code = Supervisor(*block).run();
        return code;
    } catch (const Error& error) {
        try {
            send(socket_descriptor, error_words(error));
        } catch (...) {
        }
        std::fprintf(stderr, "tactus-device-host: %s\n", error.what());
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tactus-device-host: %s\n", error.what());
    }
    return 2;
}

}  // namespace tactus::hosted
