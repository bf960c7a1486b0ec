// SPDX-License-Identifier: Apache-2.0
// The protocol of spacenavd's socket: 32 bytes per event, eight int32 of this machine. First number 0: motion x, y, z,
// rx, ry, rz, ms. 1: button pressed, 2: released, followed by its number. 3: a device was added or removed, only for
// clients that have requested protocol 1; a daemon that supports it answers the request with its four bytes. Others are
// skipped. (libspnav 1.0, src/spnav.c, proto.h)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus::spacenav {

/// Request for events about added and removed devices. An older daemon reads it as a sensitivity that is not a number,
/// and ignores it.
inline constexpr std::int32_t ask_for_devices = 0x7faa5501;

/// Deflection and buttons after the last whole event.
struct CapState {
    std::array<int, 6> deflection{};  ///< as sent by the daemon: about ±350 at full deflection, clipped at ±500
    std::uint32_t buttons = 0;  ///< bit n: button n, up to 31
    std::uint64_t events = 0;
};

/// Assembles events from a stream with arbitrary boundaries. Does not allocate.
class EventReader {
public:
    /// Time without an event after which a deflected cap counts as released, because a disconnected device sends
    /// nothing more. A held cap sends an event at every small motion, or by `repeat-interval` of the daemon.
    static constexpr std::int64_t longest_silence_ns = 1'000'000'000;

    /// Advances time; call it before `take` of the bytes that arrived meanwhile.
    void pass(std::int64_t elapsed_ns) noexcept;
    void take(std::span<const std::uint8_t> bytes) noexcept;
    const CapState& state() const noexcept { return state_; }

private:
    void accept() noexcept;

    static constexpr std::size_t size_of_event = 32;
    std::array<std::uint8_t, size_of_event> held_{};
    std::size_t size_ = 0;
    std::int64_t silence_ns_ = 0;
    CapState state_;
};

}  // namespace tactus::spacenav
