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
    /// A key that was pressed since the last call, without waiting. The terminal gives single keys until the next read(), or the
    /// end of this object.
    std::optional<char> pressed();
    /// Whether keys are those of a person now, and not answers that wait in a pipe.
    static bool is_terminal();
    /// Discards keys that were pressed before now. Only at a terminal: a pipe holds answers.
    void forget();

private:
    void prepare();
    void restore();
    std::optional<char> read_within(int milliseconds);

    termios before_{};
    bool is_raw_ = false, is_at_end_ = false;
};

}  // namespace tactus::command
