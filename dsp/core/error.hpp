// SPDX-License-Identifier: Apache-2.0
// The one exception type for bad input. Thrown only while loading or preparing, never in a tick.
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tactus {

/// A place in a text file; line and column count from 1, 0 means unknown.
struct SourceLocation {
    std::string file;
    int line = 0;
    int column = 0;
};

/// Bad input. `what()` reads "file:line:column: message"; the message says what is wrong and what to do.
class Error : public std::runtime_error {
public:
    explicit Error(std::string message) : std::runtime_error(message), message_(std::move(message)) {}
    Error(SourceLocation where, std::string message)
        : std::runtime_error(format(where, message)), where_(std::move(where)), message_(std::move(message)) {}

    const SourceLocation& where() const { return where_; }
    const std::string& message() const { return message_; }

private:
    static std::string format(const SourceLocation& where, const std::string& message);

    SourceLocation where_;
    std::string message_;
};

/// "; did you mean 'pose'?" for the candidate nearest to `word` by edit distance, or "" when none is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace tactus
