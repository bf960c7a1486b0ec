// SPDX-License-Identifier: Apache-2.0
#include "tools/command/experiment/key_reader.hpp"

#include <poll.h>
#include <unistd.h>

namespace tactus::command {

void KeyReader::prepare() {
    if (is_raw_ || isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &before_) != 0) return;
    termios raw = before_;
    // Keys at once and without echo; Ctrl-C still ends the program.
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    is_raw_ = tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

void KeyReader::restore() {
    if (is_raw_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
    is_raw_ = false;
}

std::optional<char> KeyReader::read(const std::atomic<bool>& stop) {
    prepare();
    std::optional<char> key;
    while (!stop) {
        pollfd input{STDIN_FILENO, POLLIN, 0};
        if (poll(&input, 1, 50) <= 0) continue;
        char c = 0;
        if (::read(STDIN_FILENO, &c, 1) != 1) break;
        if (!is_raw_ && (c == '\n' || c == '\r')) continue;
        key = c;
        break;
    }
    restore();
    return key;
}

void KeyReader::forget() {
    if (isatty(STDIN_FILENO) != 0) tcflush(STDIN_FILENO, TCIFLUSH);
}

}  // namespace tactus::command
