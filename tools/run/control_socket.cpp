// SPDX-License-Identifier: Apache-2.0
#include "tools/run/control_socket.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace tactus::run {

namespace {

constexpr std::size_t longest_line = 4096;
constexpr std::size_t max_callers = 16;

struct Descriptor {
    int number;
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
};

}  // namespace

ControlSocket::ControlSocket()
    : folder_(ControlFolder::Missing::make), name_(ControlFolder::name_of(static_cast<int>(::getpid()))) {
    // A socket also refuses connections between bind and listen, so this section is locked.
    const bool is_locked = folder_.lock();
    if (is_locked) folder_.remove_refusing();
    Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)};
    const sockaddr_un address = folder_.address(name_);
    const bool is_bound =
        socket.number >= 0 && ::bind(socket.number, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    const bool listens = is_bound && ::listen(socket.number, 8) == 0;
    const int code = errno;
    if (is_bound && !listens) folder_.remove(name_);
    if (is_locked) folder_.unlock();
    if (!listens)
        throw Error(fmt::format("{}: cannot listen: {}", (control_folder() / name_).string(), std::strerror(code)));
    descriptor_ = std::exchange(socket.number, -1);
}

ControlSocket::~ControlSocket() {
    for (const Caller& caller : callers_) ::close(caller.descriptor);
    ::close(descriptor_);
    folder_.remove(name_);
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
        // An answer that the client does not read is dropped.
        if (::send(caller.descriptor, said.data(), said.size(), MSG_NOSIGNAL) < 0) return false;
    }
    return !has_gone && caller.received.size() <= longest_line;
}

void ControlSocket::serve(const std::function<std::string(const std::string&)>& answer) {
    for (int caller; callers_.size() < max_callers &&
                     (caller = ::accept4(descriptor_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)) >= 0;)
        callers_.push_back({caller, {}});
    std::erase_if(callers_, [&](Caller& caller) {
        if (listen_to(caller, answer)) return false;
        ::close(caller.descriptor);
        return true;
    });
}

std::string ask_run(int process, const std::string& line) {
    const ControlFolder folder(ControlFolder::Missing::leave);
    if (process == 0) {
        const std::vector<int> processes = folder.listening();
        if (processes.empty()) throw Error("no patch runs; start one with 'tactus run PATCH'");
        if (processes.size() > 1)
            throw Error(fmt::format("several patches run; choose one with --process: {}", fmt::join(processes, ", ")));
        process = processes.front();
    }
    const Descriptor socket{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    const auto refuse = [process](const char* why) {
        throw Error(fmt::format("process {} does not run a patch of yours: {}", process, why));
    };
    if (!folder.is_there()) refuse(std::strerror(ENOENT));
    const sockaddr_un address = folder.address(ControlFolder::name_of(process));
    if (socket.number < 0 || ::connect(socket.number, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        refuse(std::strerror(errno));
    ucred other{};
    socklen_t size_of_other = sizeof other;
    if (::getsockopt(socket.number, SOL_SOCKET, SO_PEERCRED, &other, &size_of_other) != 0 || other.uid != ::getuid())
        refuse("another user listens there");
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

}  // namespace tactus::run
