// SPDX-License-Identifier: Apache-2.0
// Non-blocking input from a network client.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus::driver {

/// Reads the bytes that a socket has now into `room`, without waiting; more input stays in the socket for the next
/// call. Returns the number of bytes, or nothing if the connection is closed.
std::optional<std::size_t> read_now(int file, std::span<std::uint8_t> room) noexcept;

/// Enables TCP keep-alive: a connection whose machine or cable has failed is closed after about 4 s. Without it, a
/// connection over which nothing is sent would stay open for ever.
void keep_alive(int file) noexcept;

}  // namespace tactus::driver
