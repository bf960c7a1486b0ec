// SPDX-License-Identifier: Apache-2.0
#include "devices/driver/peer_socket.hpp"

#include <sys/socket.h>

#include <cerrno>

namespace tactus::driver {

std::optional<std::size_t> read_now(int file, std::span<std::uint8_t> room) noexcept {
    const ssize_t count = ::recv(file, room.data(), room.size(), MSG_DONTWAIT);
    if (count > 0) return static_cast<std::size_t>(count);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
    return std::nullopt;
}

}  // namespace tactus::driver
