// SPDX-License-Identifier: Apache-2.0
#include "tools/run/control_folder.hpp"

#include "dsp/core/error.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

namespace tactus::run {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view ending = ".socket";

/// The process number of "123.socket"; 0: another name.
int process_of(std::string_view name) {
    if (!name.ends_with(ending)) return 0;
    name.remove_suffix(ending.size());
    if (name.empty() || !std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; })) return 0;
    int process = 0;
    const auto [end, failure] = std::from_chars(name.data(), name.data() + name.size(), process);
    return failure == std::errc{} ? process : 0;
}

}  // namespace

fs::path control_folder() {
    if (const char* given = std::getenv("XDG_RUNTIME_DIR"); given && *given) return fs::path(given) / "tactus";
    return fmt::format("/tmp/tactus-{}", ::getuid());
}

ControlFolder::ControlFolder(Missing missing) {
    const fs::path path = control_folder();
    const auto fail = [&path](const std::string& why) {
        throw Error(fmt::format("{}: cannot be used for the control socket: {}", path.string(), why));
    };
    if (missing == Missing::make && ::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) fail(std::strerror(errno));
    folder_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder_ < 0) {
        if (missing == Missing::leave && errno == ENOENT) return;
        struct stat link{};
        const int code = errno;
        const bool is_link = ::lstat(path.c_str(), &link) == 0 && S_ISLNK(link.st_mode);
        fail(is_link ? "it is a link; remove it" : std::strerror(code));
    }
    struct stat status{};
    const bool is_known = ::fstat(folder_, &status) == 0;
    if (is_known && status.st_uid == ::getuid() && (status.st_mode & 077) == 0) return;
    ::close(folder_);
    if (!is_known || status.st_uid != ::getuid()) fail("it belongs to another user; set XDG_RUNTIME_DIR");
    fail(fmt::format("others have access to it; 'chmod 700 {}' if it is yours", path.string()));
}

ControlFolder::~ControlFolder() {
    if (folder_ >= 0) ::close(folder_);
}

std::string ControlFolder::name_of(int process) { return fmt::format("{}{}", process, ending); }

sockaddr_un ControlFolder::address(const std::string& name) const {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    // Via the descriptor: the path may be too long for a socket, or may have been replaced.
    const std::string path = fmt::format("/proc/self/fd/{}/{}", folder_, name);
    if (folder_ < 0 || path.size() >= sizeof address.sun_path) throw Error("there is no control socket");
    std::strcpy(address.sun_path, path.c_str());
    return address;
}

std::vector<std::string> ControlFolder::names() const {
    std::vector<std::string> names;
    if (folder_ < 0) return names;
    const int again = ::openat(folder_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const std::unique_ptr<DIR, int (*)(DIR*)> folder(again < 0 ? nullptr : ::fdopendir(again), ::closedir);
    if (!folder) {
        if (again >= 0) ::close(again);
        return names;
    }
    while (const dirent* entry = ::readdir(folder.get())) {
        struct stat status{};
        if (process_of(entry->d_name) > 0 && ::fstatat(folder_, entry->d_name, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISSOCK(status.st_mode))
            names.emplace_back(entry->d_name);
    }
    return names;
}

int ControlFolder::try_connection(const std::string& name) const {
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket < 0) return errno;
    const sockaddr_un address = this->address(name);
    const int code = ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
    ::close(socket);
    // The queue of connections is full: a process is listening.
    return code == EAGAIN ? 0 : code;
}

std::vector<int> ControlFolder::listening() const {
    std::vector<int> processes;
    for (const std::string& name : names())
        if (try_connection(name) == 0) processes.push_back(process_of(name));
    std::ranges::sort(processes);
    return processes;
}

void ControlFolder::remove_refusing() const {
    for (const std::string& name : names())
        if (try_connection(name) == ECONNREFUSED) remove(name);
}

void ControlFolder::remove(const std::string& name) const { ::unlinkat(folder_, name.c_str(), 0); }

bool ControlFolder::lock() const {
    constexpr int tries = 50;
    for (int n = 0; n < tries; ++n) {
        if (::flock(folder_, LOCK_EX | LOCK_NB) == 0) return true;
        ::usleep(20'000);
    }
    return false;
}

void ControlFolder::unlock() const { ::flock(folder_, LOCK_UN); }

}  // namespace tactus::run
