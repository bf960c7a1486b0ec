// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tactus::gripper {

/// A serial line, 8 data bits, no parity, one stop bit, no flow control (termios). Never waits.
class SerialPort {
public:
    SerialPort() = default;
    ~SerialPort() { close(); }
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;

    /// Opens the line. Returns an empty text, or the reason of the failure. `baud` must be a rate of termios.
    std::string open(const std::string& path, int baud) noexcept(false);
    void close() noexcept;
    bool is_open() const noexcept { return file_ >= 0; }

    /// Reads the available bytes, at most the size of `into`; closes the line when it is lost.
    std::size_t read(std::span<std::uint8_t> into) noexcept;
    /// True when everything was written; false when the buffer is full or the line is lost.
    bool write(std::span<const std::uint8_t> bytes) noexcept;

    static bool knows_baud(int baud) noexcept;

private:
    int file_ = -1;
};

}  // namespace tactus::gripper
