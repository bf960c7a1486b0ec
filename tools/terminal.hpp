// SPDX-License-Identifier: Apache-2.0
// A line on the terminal that is written over; nothing when standard error is no terminal.
#pragma once

#include <cstdio>
#include <string>

#include <unistd.h>

namespace tactus {

class LiveLine {
public:
    ~LiveLine() { clear(); }
    void show(const std::string& text) {
        if (!is_terminal_) return;
        std::fprintf(stderr, "\r\033[K%s", text.c_str());
        std::fflush(stderr);
        shown_ = true;
    }
    void clear() {
        if (shown_) std::fprintf(stderr, "\r\033[K");
        shown_ = false;
    }

private:
    bool is_terminal_ = isatty(STDERR_FILENO) == 1, shown_ = false;
};

}  // namespace tactus
