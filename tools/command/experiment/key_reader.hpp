// SPDX-License-Identifier: Apache-2.0
// Single keys from the terminal, or characters from a pipe.
#pragma once

#include <termios.h>

#include <atomic>
#include <optional>

namespace tactus::command {

class KeyReader {
public:
    KeyReader() = default;
    ~KeyReader() { restore(); }
    KeyReader(const KeyReader&) = delete;
    KeyReader& operator=(const KeyReader&) = delete;

    /// Waits for a key; line ends of a pipe are left out. None: the input ended, or `stop` was set.
    std::optional<char> read(const std::atomic<bool>& stop);
    /// Discards keys that were pressed before now. Only at a terminal: a pipe holds answers.
    void forget();

private:
    void prepare();
    void restore();

    termios before_{};
    bool is_raw_ = false;
};

}  // namespace tactus::command
