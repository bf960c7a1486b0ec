// SPDX-License-Identifier: Apache-2.0
// A display without a screen, for tests that open the window.
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

namespace tactus::test {

class VirtualDisplay {
public:
    explicit VirtualDisplay(int width = 1800, int height = 1200) {
        const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
        int ends[2];
        if (::pipe(ends) != 0) return;
        process_ = ::fork();
        if (process_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGTERM);
            ::dup2(ends[1], 3);
            for (int other = 4; other < 64; ++other) ::close(other);
            if (!::freopen("/dev/null", "w", stderr)) ::_exit(127);
            ::execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", screen.c_str(), "-nolisten", "tcp", nullptr);
            ::_exit(127);
        }
        ::close(ends[1]);
        char c = 0;
        while (::read(ends[0], &c, 1) == 1 && c != '\n') number_ += c;
        ::close(ends[0]);
    }
    ~VirtualDisplay() {
        if (process_ <= 0) return;
        ::kill(process_, SIGTERM);
        ::waitpid(process_, nullptr, 0);
    }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;

    /// False when Xvfb is not installed.
    bool is_there() const { return !number_.empty(); }
    const std::string& number() const { return number_; }
    /// What stands before a command that is to use it.
    /// The graphics driver keeps what it has allocated to the end, and is gone by then: in a sanitized build its leaks
    /// have no names.
    std::string environment() const { return "DISPLAY=:" + number_ + " LP_NUM_THREADS=1 ASAN_OPTIONS=detect_leaks=0 "; }

private:
    pid_t process_ = -1;
    std::string number_;
};

}  // namespace tactus::test
