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

    /// Empty when it is open; else why it is not, for people. `baud` is one that termios knows.
    std::string open(const std::string& path, int baud) noexcept(false);
    void close() noexcept;
    bool is_open() const noexcept { return file_ >= 0; }

    /// What has arrived, at most the size of `into`; closes the line when it is gone.
    std::size_t read(std::span<std::uint8_t> into) noexcept;
    /// True when all of it was taken; the line may be full or gone.
    bool write(std::span<const std::uint8_t> bytes) noexcept;

    static bool knows_baud(int baud) noexcept;

private:
    int file_ = -1;
};

}  // namespace tactus::gripper
