// SPDX-License-Identifier: Apache-2.0
// spacenavd as a test plays it.
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

namespace tactus::test {

using Event = std::array<std::int32_t, 8>;

inline Event motion(int x, int y, int z, int rx, int ry, int rz) { return {0, x, y, z, rx, ry, rz, 16}; }

class SpaceDaemon {
public:
    SpaceDaemon() {
        path = (std::filesystem::temp_directory_path() / ("tactus_spnav_" + std::to_string(::getpid()))).string();
        listen();
    }
    ~SpaceDaemon() { leave(); }
    void listen() {
        listener_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path.data(), path.size());
        ::unlink(path.c_str());
        ::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address);
        ::listen(listener_, 4);
    }
    void leave() {
        if (client_ >= 0) ::close(client_);
        if (listener_ >= 0) ::close(listener_);
        client_ = listener_ = -1;
        ::unlink(path.c_str());
    }
    void accept() { client_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); }
    /// Takes a client that has come, in place of the one before.
    void accept_now() {
        pollfd one{listener_, POLLIN, 0};
        if (::poll(&one, 1, 0) <= 0) return;
        if (client_ >= 0) ::close(client_);
        accept();
    }
    void send(const Event& event) { send_bytes(event.data(), sizeof event); }
    void send_bytes(const void* bytes, std::size_t size) {
        [[maybe_unused]] const auto sent = ::send(client_, bytes, size, MSG_NOSIGNAL);
    }
    int client() const { return client_; }

    std::string path;

private:
    int listener_ = -1, client_ = -1;
};

}  // namespace tactus::test
