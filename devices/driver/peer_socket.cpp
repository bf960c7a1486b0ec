// SPDX-License-Identifier: Apache-2.0
#include "devices/driver/peer_socket.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>

namespace tactus::driver {

std::optional<std::size_t> read_now(int file, std::span<std::uint8_t> room) noexcept {
    const ssize_t count = ::recv(file, room.data(), room.size(), MSG_DONTWAIT);
    if (count > 0) return static_cast<std::size_t>(count);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    return std::nullopt;
}

void keep_alive(int file) noexcept {
    const int on = 1, first_s = 1, again_s = 1, times = 3;
    ::setsockopt(file, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    ::setsockopt(file, IPPROTO_TCP, TCP_KEEPIDLE, &first_s, sizeof first_s);
    ::setsockopt(file, IPPROTO_TCP, TCP_KEEPINTVL, &again_s, sizeof again_s);
    ::setsockopt(file, IPPROTO_TCP, TCP_KEEPCNT, &times, sizeof times);
}

}  // namespace tactus::driver
