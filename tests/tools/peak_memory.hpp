// SPDX-License-Identifier: Apache-2.0
// How much memory the command takes.
#pragma once

#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <string>
#include <vector>

namespace tactus::test {

struct PeakMemory {
    double kilobytes = 0.0;
    int code = -1;  ///< exit code; -1: ended by a signal
};

/// Runs the command with these arguments and nothing printed. `max_data`: bytes of data that it may hold; 0: no limit.
inline PeakMemory peak_memory(const std::vector<std::string>& arguments, rlim_t max_data = 0) {
    const std::string program = command();
    std::vector<char*> words{const_cast<char*>("tactus")};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        const rlimit most{max_data, max_data};
        if (max_data > 0 && ::setrlimit(RLIMIT_DATA, &most) != 0) ::_exit(126);
        if (std::freopen("/dev/null", "w", stdout) == nullptr || std::freopen("/dev/null", "w", stderr) == nullptr)
            ::_exit(126);
        ::execv(program.c_str(), words.data());
        ::_exit(127);
    }
    int status = 0;
    rusage used{};
    REQUIRE(::wait4(child, &status, 0, &used) == child);
    return {static_cast<double>(used.ru_maxrss), WIFEXITED(status) ? WEXITSTATUS(status) : -1};
}

}  // namespace tactus::test
