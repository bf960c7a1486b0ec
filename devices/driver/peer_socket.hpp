// SPDX-License-Identifier: Apache-2.0
// What a peer has sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus::driver {

/// Reads what a socket has now into `room`, without waiting: a flood waits in the socket for the next call. How many bytes
/// there were; none when the peer is gone.
std::optional<std::size_t> read_now(int file, std::span<std::uint8_t> room) noexcept;

/// Lets the system ask whether a silent peer is still there: one whose machine or cable is gone counts as gone after some
/// 4 s, instead of never when nothing is sent to it.
void keep_alive(int file) noexcept;

}  // namespace tactus::driver
