// SPDX-License-Identifier: Apache-2.0
#include "tests/campaign/limited_run.hpp"

#include "tests/support/places.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace tactus::campaign {

namespace {

[[noreturn]] void become(std::vector<char*>& words, const std::filesystem::path& folder, const RunLimits& limits,
                         const std::filesystem::path& told) {
    const auto limit = [](int what, rlim_t most) {
        const rlimit both{most, most};
        setrlimit(static_cast<__rlimit_resource>(what), &both);
    };
    limit(RLIMIT_CPU, static_cast<rlim_t>(limits.processor_s));
    limit(RLIMIT_CORE, 0);
    // Only so that a mutant cannot take the machine with it: what counts is what was resident.
    limit(RLIMIT_DATA, rlim_t{8} << 30);
    limit(RLIMIT_FSIZE, rlim_t{1} << 30);
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, 0);
    const int out = open(told.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    for (int n = 1; n < 3; ++n) dup2(out < 0 ? nowhere : out, n);
    if (chdir(folder.c_str()) == 0) execv(words[0], words.data());
    _exit(127);
}

}  // namespace

std::string tried_command() {
    const char* other = std::getenv("TACTUS");
    return other ? other : test::command();
}

RunEnd run_limited(const std::vector<std::string>& words, const std::filesystem::path& folder, const RunLimits& limits,
                   const std::filesystem::path& told) {
    std::vector<std::string> copy = words;
    std::vector<char*> pointers;
    for (std::string& word : copy) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) return {"no process could be made", -1};
    if (child == 0) become(pointers, folder, limits, told);
    int status = 0;
    rusage used{};
    bool is_late = false;
    const timespec wait{0, 2'000'000};
    for (int waits = 0; wait4(child, &status, WNOHANG, &used) == 0; ++waits) {
        if (waits == limits.wall_s * 500) {
            is_late = true;
            kill(child, SIGKILL);
        }
        nanosleep(&wait, nullptr);
    }
    const double resident_mb = static_cast<double>(used.ru_maxrss) / 1024.0;
    const long processor_s = used.ru_utime.tv_sec + used.ru_stime.tv_sec;
    const auto fault = [](std::string text) { return RunEnd{std::move(text), -1}; };
    if (is_late) return fault(fmt::format("hung for {} s", limits.wall_s));
    if (processor_s >= limits.processor_s) return fault(fmt::format("took more than {} s", limits.processor_s));
    if (WIFSIGNALED(status))
        return fault(fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))));
    if (WEXITSTATUS(status) > 3) return fault(fmt::format("exit code {}", WEXITSTATUS(status)));
    if (resident_mb > limits.resident_mb) return fault(fmt::format("took {:.0f} MB", resident_mb));
    return {{}, WEXITSTATUS(status)};
}

}  // namespace tactus::campaign
