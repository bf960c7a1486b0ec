// SPDX-License-Identifier: Apache-2.0
#include "tools/session/control_socket.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace tactus::session {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_line = 4096;
constexpr std::size_t most_callers = 16;

sockaddr_un address_of(const fs::path& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.string().size() >= sizeof address.sun_path)
        throw Error(fmt::format("{}: too long a path for a socket; set XDG_RUNTIME_DIR", path.string()));
    std::strcpy(address.sun_path, path.c_str());
    return address;
}

/// Process of "123.socket", 0: none or gone.
int process_of(const fs::path& socket) {
    const int process = std::atoi(socket.stem().c_str());
    return socket.extension() == ".socket" && process > 0 && ::kill(process, 0) == 0 ? process : 0;
}

std::vector<int> running() {
    std::vector<int> processes;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(control_folder(), ignored))
        if (const int process = process_of(entry.path())) processes.push_back(process);
    std::ranges::sort(processes);
    return processes;
}

struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
};

}  // namespace

fs::path control_folder() {
    if (const char* given = std::getenv("XDG_RUNTIME_DIR"); given && *given) return fs::path(given) / "tactus";
    return fmt::format("/tmp/tactus-{}", ::getuid());
}

ControlSocket::ControlSocket() {
    const fs::path folder = control_folder();
    std::error_code failure;
    fs::create_directories(folder, failure);
    struct stat status{};
    if (failure || ::stat(folder.c_str(), &status) != 0 || status.st_uid != ::getuid())
        throw Error(fmt::format("{}: cannot be used for the control socket", folder.string()));
    fs::permissions(folder, fs::perms::owner_all);
    // What crashed runs left behind.
    for (const auto& entry : fs::directory_iterator(folder, failure))
        if (process_of(entry.path()) == 0) fs::remove(entry.path(), failure);
    path_ = folder / fmt::format("{}.socket", ::getpid());
    fs::remove(path_, failure);
    descriptor_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const sockaddr_un address = address_of(path_);
    if (descriptor_ < 0 || ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(descriptor_, 8) != 0)
        throw Error(fmt::format("{}: cannot listen: {}", path_.string(), std::strerror(errno)));
}

ControlSocket::~ControlSocket() {
    for (const Caller& caller : callers_) ::close(caller.descriptor);
    if (descriptor_ >= 0) ::close(descriptor_);
    std::error_code ignored;
    fs::remove(path_, ignored);
}

bool ControlSocket::listen_to(Caller& caller, const std::function<std::string(const std::string&)>& answer) {
    char buffer[1024];
    ssize_t size;
    while ((size = ::recv(caller.descriptor, buffer, sizeof buffer, 0)) > 0)
        caller.received.append(buffer, static_cast<std::size_t>(size));
    const bool has_gone = size == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
    for (std::size_t end; (end = caller.received.find('\n')) != std::string::npos;) {
        const std::string said = answer(caller.received.substr(0, end)) + "\n";
        caller.received.erase(0, end + 1);
        // Who does not listen to the answer does not get it.
        if (::send(caller.descriptor, said.data(), said.size(), MSG_NOSIGNAL) < 0) return false;
    }
    return !has_gone && caller.received.size() <= longest_line;
}

void ControlSocket::serve(const std::function<std::string(const std::string&)>& answer) {
    for (int caller; callers_.size() < most_callers &&
                     (caller = ::accept4(descriptor_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)) >= 0;)
        callers_.push_back({caller, {}});
    std::erase_if(callers_, [&](Caller& caller) {
        if (listen_to(caller, answer)) return false;
        ::close(caller.descriptor);
        return true;
    });
}

std::string ask_run(int process, const std::string& line) {
    const std::vector<int> processes = running();
    if (process == 0) {
        if (processes.empty()) throw Error("no patch runs; start one with 'tactus run PATCH'");
        if (processes.size() > 1)
            throw Error(fmt::format("several patches run; say which with --process: {}", fmt::join(processes, ", ")));
        process = processes.front();
    }
    const fs::path path = control_folder() / fmt::format("{}.socket", process);
    const Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    const sockaddr_un address = address_of(path);
    if (socket.number < 0 || ::connect(socket.number, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        throw Error(fmt::format("process {} does not run a patch of yours: {}", process, std::strerror(errno)));
    const std::string sent = line + "\n";
    if (::send(socket.number, sent.data(), sent.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(sent.size()))
        throw Error(fmt::format("process {}: {}", process, std::strerror(errno)));
    std::string said;
    pollfd wait{socket.number, POLLIN, 0};
    while (said.find('\n') == std::string::npos) {
        char buffer[1024];
        if (::poll(&wait, 1, 5000) <= 0) throw Error(fmt::format("process {} does not answer", process));
        const ssize_t size = ::recv(socket.number, buffer, sizeof buffer, 0);
        if (size <= 0) throw Error(fmt::format("process {} ended before it answered", process));
        said.append(buffer, static_cast<std::size_t>(size));
    }
    return said.substr(0, said.find('\n'));
}

}  // namespace tactus::session
