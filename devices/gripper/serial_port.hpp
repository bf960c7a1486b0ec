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

    /// Opens the line for exclusive use. Returns an empty text, or the reason of the failure. `baud` must be a rate of
    /// termios.
    std::string open(const std::string& path, int baud) noexcept(false);
    void close() noexcept;
    bool is_open() const noexcept { return file_ >= 0; }

    /// Reads the available bytes, at most the size of `into`; closes the line when it is lost.
    std::size_t read(std::span<std::uint8_t> into) noexcept;
    /// Sends a message of at most `longest` bytes. If the line is nearly full, it accepts only a part; the rest is sent
    /// before any other message, because the receiver would otherwise interpret the next message as that rest. Returns
    /// true if the line has accepted at least the beginning; false if it accepts nothing now (the message is dropped)
    /// or is lost (it is then closed).
    bool send(std::span<const std::uint8_t> message) noexcept;

    static bool knows_baud(int baud) noexcept;

private:
    /// Returns the number of bytes accepted; closes the line if it is lost.
    std::size_t write_some(std::span<const std::uint8_t> bytes) noexcept;

    int file_ = -1;
    std::array<std::uint8_t, longest> rest_{};  ///< of a partly sent message
    std::size_t rest_size_ = 0;
};

}  // namespace tactus::gripper
