// SPDX-License-Identifier: Apache-2.0
// What spacenavd says on its socket: 32 bytes an event, eight int32 of this machine. Motion: 0, x, y, z, rx, ry, rz, ms.
// A button: 1 pressed or 2 released, and its number. 3: a device came or went, only for clients that asked for protocol 1;
// a daemon that knows it answers the four bytes of the question. Others are skipped. (libspnav 1.0, src/spnav.c, proto.h)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus::spacenav {

/// What a client sends to hear of devices that come and go. To an older daemon it is a sensitivity that is no number, which
/// it ignores.
inline constexpr std::int32_t ask_for_devices = 0x7faa5501;

/// Deflection and buttons after the last whole event.
struct CapState {
    std::array<int, 6> deflection{};  ///< as the daemon sends it: about ±350 at full deflection, clipped at ±500
    std::uint32_t buttons = 0;  ///< bit n: button n, up to 31
    std::uint64_t events = 0;
};

/// Puts events together from a stream that is cut anywhere. Does not allocate.
class EventReader {
public:
    /// After so long without an event a deflected cap counts as let go: a device that is pulled out says nothing more.
    /// A cap that is held says something at every small motion, or by `repeat-interval` of the daemon.
    static constexpr std::int64_t longest_silence_ns = 1'000'000'000;

    /// Time passes; before `take` of what has come in it.
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
