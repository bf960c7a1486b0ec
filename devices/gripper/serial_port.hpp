// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tactus::gripper {

/// A serial line, 8 data bits, no parity, one stop bit, no flow control (termios). Never waits.
class SerialPort {
public:
    static constexpr std::size_t longest = 128;  ///< bytes of a message

    SerialPort() = default;
    ~SerialPort() { close(); }
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;

    /// Opens the line, for this program alone. Returns an empty text, or the reason of the failure. `baud` must be a rate
    /// of termios.
    std::string open(const std::string& path, int baud) noexcept(false);
    void close() noexcept;
    bool is_open() const noexcept { return file_ >= 0; }

    /// Reads the available bytes, at most the size of `into`; closes the line when it is lost.
    std::size_t read(std::span<std::uint8_t> into) noexcept;
    /// Sends a message of at most `longest` bytes. A line that is nearly full takes a part of one: its rest is sent before
    /// any other, because a receiver takes the bytes of the next message for it. True: the line has begun to take this
    /// one; false: it takes nothing now (the message is dropped), or it is lost, and then it is closed.
    bool send(std::span<const std::uint8_t> message) noexcept;

    static bool knows_baud(int baud) noexcept;

private:
    /// How many bytes the line took; closes it when it is lost.
    std::size_t write_some(std::span<const std::uint8_t> bytes) noexcept;

    int file_ = -1;
    std::array<std::uint8_t, longest> rest_{};  ///< of the message that was begun
    std::size_t rest_size_ = 0;
};

}  // namespace tactus::gripper
