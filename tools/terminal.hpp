// SPDX-License-Identifier: Apache-2.0
// Status lines that are overwritten in place; nothing when standard error is not a terminal.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include <sys/ioctl.h>
#include <unistd.h>

namespace tactus {

/// Prints a text and ignores failures: a closed terminal or pipe must not end the program.
inline void say(std::FILE* to, const std::string& text) {
    std::fputs(text.c_str(), to);
    std::fflush(to);
}

/// The first `columns` characters of a UTF-8 line. A wrapped line could not be overwritten.
inline std::string_view clipped(std::string_view line, std::size_t columns) {
    std::size_t seen = 0;
    for (std::size_t i = 0; i < line.size(); ++i)
        if ((line[i] & 0xc0) != 0x80 && seen++ == columns) return line.substr(0, i);
    return line;
}

class LiveLine {
public:
    ~LiveLine() { clear(); }
    bool is_terminal() const { return is_terminal_; }
    /// Shows one or several lines, separated by line ends.
    void show(std::string_view text) {
        if (!is_terminal_) return;
        std::string out = back();
        winsize size{};
        const std::size_t columns =
            ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : std::size_t{80};
        lines_ = 0;
        while (true) {
            const std::size_t end = text.find('\n');
            out += clipped(text.substr(0, end), columns);
            ++lines_;
            if (end == std::string_view::npos) break;
            out += '\n';
            text.remove_prefix(end + 1);
        }
        std::fputs(out.c_str(), stderr);
        std::fflush(stderr);
    }
    void clear() {
        if (lines_ > 0) std::fputs(back().c_str(), stderr);
        lines_ = 0;
    }

private:
    /// Erases the shown lines and moves the cursor to their start.
    std::string back() const {
        return (lines_ > 1 ? "\033[" + std::to_string(lines_ - 1) + "A" : std::string()) + "\r\033[J";
    }

    bool is_terminal_ = isatty(STDERR_FILENO) == 1;
    std::size_t lines_ = 0;
};

}  // namespace tactus
