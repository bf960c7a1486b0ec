// SPDX-License-Identifier: Apache-2.0
#include "assets/file/growing_file.hpp"

#include "dsp/core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace tactus::file {

namespace {

constexpr std::size_t max_waiting = 1 << 12;  // bytes

}  // namespace

GrowingFile::GrowingFile(const std::filesystem::path& path, std::filesystem::path shown)
    : shown_(shown.empty() ? path : std::move(shown)),
      handle_(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666)) {
    if (handle_ < 0) fail(errno);
    // Truncated only after the lock is held. Other failures mean a file system without locks.
    if (::flock(handle_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(handle_);
        throw Error(fmt::format("{}: another program writes to this file; choose another name", shown_.string()));
    }
    if (::ftruncate(handle_, 0) != 0 && errno != EINVAL) {
        const int code = errno;
        ::close(handle_);
        fail(code);
    }
}

GrowingFile::~GrowingFile() {
    try {
        close();
    } catch (const Error&) {
        // The destructor ignores failures; call close() to see them.
    }
}

void GrowingFile::fail(int code) {
    has_failed_ = true;
    waiting_ = {};
    ends_ = {};
    throw Error(fmt::format("{}: cannot be written: {}", shown_.string(), std::strerror(code)));
}

void GrowingFile::append(std::string_view record) {
    if (has_failed_) return;
    waiting_ += record;
    ends_.push_back(waiting_.size());
    if (waiting_.size() >= max_waiting) flush();
}

void GrowingFile::flush() {
    if (has_failed_) return;
    std::size_t written = 0;
    while (written < waiting_.size()) {
        const ssize_t count = ::write(handle_, waiting_.data() + written, waiting_.size() - written);
        if (count > 0) {
            written += static_cast<std::size_t>(count);
            continue;
        }
        if (count < 0 && errno == EINTR) continue;
        const int code = count < 0 ? errno : EIO;
        const auto cut = std::ranges::upper_bound(ends_, written);
        if (cut != ends_.begin()) size_ += static_cast<std::int64_t>(*(cut - 1));
        // If truncation fails as well, the file ends with a partial record, which readers of crashed runs accept.
        while (::ftruncate(handle_, size_) != 0 && errno == EINTR) {
        }
        fail(code);
    }
    size_ += static_cast<std::int64_t>(written);
    waiting_.clear();
    ends_.clear();
}

void GrowingFile::close() {
    if (handle_ < 0) return;
    const auto shut = [this] { return ::close(std::exchange(handle_, -1)) == 0 || errno == EINTR; };
    try {
        flush();
    } catch (const Error&) {
        shut();
        throw;
    }
    // Network file systems may report a full disk only on close.
    if (!shut() && !has_failed_) fail(errno);
}

}  // namespace tactus::file
