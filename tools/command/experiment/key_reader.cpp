// SPDX-License-Identifier: Apache-2.0
#include "tools/command/experiment/key_reader.hpp"

#include <poll.h>
#include <unistd.h>

namespace tactus::command {

void KeyReader::prepare() {
    if (is_raw_ || !is_terminal() || tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios raw = before_;
    // Keys at once and without echo; Ctrl-C still ends the program.
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    is_raw_ = tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

void KeyReader::restore() {
    if (is_raw_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    is_raw_ = false;
}

std::optional<char> KeyReader::read_within(int milliseconds) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (is_at_end_ || poll(&input, 1, milliseconds) <= 0) return std::nullopt;
    char c = 0;
    is_at_end_ = ::read(STDIN_FILENO, &c, 1) != 1;
    if (is_at_end_ || (!is_raw_ && (c == '\n' || c == '\r'))) return std::nullopt;
    return c;
}

std::optional<char> KeyReader::read(const std::atomic<bool>& stop) {
    prepare();
    std::optional<char> key;
    while (!stop && !is_at_end_ && !key) key = read_within(50);
    restore();
    return key;
}

std::optional<char> KeyReader::pressed() {
    prepare();
    return read_within(0);
}

bool KeyReader::is_terminal() { return isatty(STDIN_FILENO) != 0; }

void KeyReader::forget() {
    if (is_terminal()) tcflush(STDIN_FILENO, TCIFLUSH);
}

}  // namespace tactus::command
