// SPDX-License-Identifier: Apache-2.0
#include "assets/file/part_lock.hpp"

#include "dsp/core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tactus::file {

namespace {

/// The previous holder may have renamed or removed the file.
bool is_still_there(int handle, const std::filesystem::path& file) {
    struct stat held{}, named{};
    return ::fstat(handle, &held) == 0 && ::stat(file.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
           held.st_ino == named.st_ino;
}

}  // namespace

PartLock::PartLock(const std::filesystem::path& part, const std::filesystem::path& path) {
    // Some file systems report a new inode number on each call; locks cannot work there.
    constexpr int max_tries = 100;
    for (int n = 1;; ++n) {
        handle_ = ::open(part.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (handle_ < 0) throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
        const int code = ::flock(handle_, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
        if (code == EWOULDBLOCK) {
            ::close(handle_);
            throw Error(
                fmt::format("{}: another program is writing this file; try again when it has ended, or choose "
                            "another name",
                            path.string()));
        }
        // Other failures mean a file system without locks.
        if (code != 0 || n == max_tries || is_still_there(handle_, part)) return;
        ::close(handle_);
    }
}

PartLock::~PartLock() { ::close(handle_); }

}  // namespace tactus::file
