// SPDX-License-Identifier: Apache-2.0
#include "devices/gripper/serial_port.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace tactus::gripper {

namespace {

constexpr std::array<std::pair<int, speed_t>, 10> speeds{{{9600, B9600},
                                                          {19200, B19200},
                                                          {38400, B38400},
                                                          {57600, B57600},
                                                          {115200, B115200},
                                                          {230400, B230400},
                                                          {460800, B460800},
                                                          {500000, B500000},
                                                          {921600, B921600},
                                                          {1000000, B1000000}}};

speed_t speed_of(int baud) noexcept {
    for (const auto& [number, speed] : speeds)
        if (number == baud) return speed;
    return B0;
}

}  // namespace

bool SerialPort::knows_baud(int baud) noexcept { return speed_of(baud) != B0; }

std::string SerialPort::open(const std::string& path, int baud) {
    close();
    const int file = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) return fmt::format("cannot open {}: {}", path, std::strerror(errno));
    // Two programs that drive the same motors would each undo what the other limits.
    if (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(file);
        return fmt::format("{} is in use: another run or program has it open", path);
    }
    termios line{};
    if (::tcgetattr(file, &line) != 0) {
        ::close(file);
        return fmt::format("{} is not a serial line", path);
    }
    ::cfmakeraw(&line);
    line.c_cflag |= CLOCAL | CREAD;
    line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
    line.c_cc[VMIN] = 0;
    line.c_cc[VTIME] = 0;
    ::cfsetispeed(&line, speed_of(baud));
    ::cfsetospeed(&line, speed_of(baud));
    if (::tcsetattr(file, TCSANOW, &line) != 0) {
        const std::string why = fmt::format("{} cannot run at {} baud: {}", path, baud, std::strerror(errno));
        ::close(file);
        return why;
    }
    ::tcflush(file, TCIOFLUSH);
    file_ = file;
    return {};
}

void SerialPort::close() noexcept {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
    rest_size_ = 0;
}

std::size_t SerialPort::read(std::span<std::uint8_t> into) noexcept {
    if (file_ < 0) return 0;
    const ssize_t count = ::read(file_, into.data(), into.size());
    if (count > 0) return static_cast<std::size_t>(count);
    // With VMIN 0 an idle line reads 0 bytes; a lost line gives EIO or a similar error.
    if (count < 0 && errno != EAGAIN && errno != EINTR) close();
    return 0;
}

std::size_t SerialPort::write_some(std::span<const std::uint8_t> bytes) noexcept {
    if (file_ < 0) return 0;
    const ssize_t count = ::write(file_, bytes.data(), bytes.size());
    if (count < 0 && errno != EAGAIN && errno != EINTR) close();
    return count > 0 ? static_cast<std::size_t>(count) : 0;
}

bool SerialPort::send(std::span<const std::uint8_t> message) noexcept {
    if (message.size() > longest) return false;
    if (rest_size_ > 0) {
        const std::size_t sent = write_some({rest_.data(), rest_size_});
        if (!is_open()) return false;
        std::copy_n(rest_.begin() + static_cast<std::ptrdiff_t>(sent), rest_size_ - sent, rest_.begin());
        rest_size_ -= sent;
        if (rest_size_ > 0) return false;
    }
    const std::size_t sent = write_some(message);
    if (sent == 0) return false;
    rest_size_ = message.size() - sent;
    std::copy_n(message.begin() + static_cast<std::ptrdiff_t>(sent), rest_size_, rest_.begin());
    return true;
}

}  // namespace tactus::gripper
