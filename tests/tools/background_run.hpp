// SPDX-License-Identifier: Apache-2.0
// A live run in a process of its own, that a test may end as it likes.
#pragma once

#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

namespace tactus::test {

/// A run in the background, live or offline.
class Run {
public:
    Run(const Folder& folder, const std::string& arguments, const std::string& verb = "run") {
        process_ = ::fork();
        if (process_ != 0) return;
        const std::string command = "exec " + tactus::test::command() + " " + verb + " " + arguments + " >" +
                                    (folder.path / "run.out").string() + " 2>" + (folder.path / "run.err").string();
        ::setenv("XDG_RUNTIME_DIR", folder.path.c_str(), 1);
        ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
        ::_exit(127);
    }
    ~Run() {
        if (process_ > 0) stop(SIGKILL);
    }
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;
    void signal(int number) const { ::kill(process_, number); }
    int stop(int signal) {
        int status = 0;
        ::kill(process_, signal);
        ::waitpid(process_, &status, 0);
        process_ = -1;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t process_ = -1;
};

inline bool wait_for(const std::function<bool()>& condition) {
    for (int i = 0; i < 600; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
}

}  // namespace tactus::test
