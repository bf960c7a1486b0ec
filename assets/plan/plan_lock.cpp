// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_lock.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tactus::plan {

namespace {

constexpr std::int64_t pause_ns = 20'000'000;

/// The previous holder of the lock may have removed its file.
bool is_still_there(int handle, const std::filesystem::path& file) {
    struct stat held{}, named{};
    return ::fstat(handle, &held) == 0 && ::stat(file.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
           held.st_ino == named.st_ino;
}

}  // namespace

PlanLock::PlanLock(const std::filesystem::path& plan, std::chrono::milliseconds patience)
    : file_(plan.parent_path() / ("." + plan.filename().string() + ".lock")) {
    const std::int64_t until = steady_ns() + std::chrono::nanoseconds(patience).count();
    for (;;) {
        handle_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (handle_ < 0) throw Error(fmt::format("{}: cannot be changed: {}", plan.string(), std::strerror(errno)));
        if (::flock(handle_, LOCK_EX | LOCK_NB) == 0) {
            if (is_still_there(handle_, file_)) return;
        } else if (errno != EWOULDBLOCK && errno != EINTR) return;  // a file system without locks
        ::close(handle_);
        if (steady_ns() > until)
            throw Error(
                fmt::format("{}: another program (a run or another 'tactus plan') is changing this plan; nothing was "
                            "changed, try again when it has ended",
                            plan.string()));
        sleep_for(pause_ns);
    }
}

PlanLock::~PlanLock() {
    ::unlink(file_.c_str());
    ::close(handle_);
}

}  // namespace tactus::plan
