// SPDX-License-Identifier: Apache-2.0
// Messages between an engine and a device's process while a device is opened: lists of words over a packet socket.
// While the device runs, the only event on the socket is that it is closed.
#pragma once

#include "dsp/core/error.hpp"

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::hosted {

using Words = std::vector<std::string>;

inline constexpr std::size_t longest_message = 128 * 1024;  ///< bytes

/// Throws Error if the words exceed the maximum size. A closed socket is detected by `receive`.
void send(int socket, const Words& words);

struct Received {
    enum Kind { words, nothing, closed } kind = nothing;
    Words said;
};
/// Waits at most `longest`; without it, for ever. A malformed message counts as a closed socket.
Received receive(int socket, std::optional<std::chrono::milliseconds> longest);

// The first word is the kind of message.
inline constexpr const char* say_open =
    "open";  ///< driver, owner, place, then name, text, scope and place of each option
inline constexpr const char* say_resolve = "resolve";  ///< name of an asset; answered by `path` or `error`
inline constexpr const char* say_path = "path";
inline constexpr const char* say_ready = "ready";
inline constexpr const char* say_prepare = "prepare";  ///< tick period in s, as a hexadecimal number
inline constexpr const char* say_prepared = "prepared";
inline constexpr const char* say_error = "error";  ///< place, message

/// Appends file, line and column as three words.
void append(Words& words, const SourceLocation& where);
/// Throws Error if they are missing.
SourceLocation take_location(std::span<const std::string>& words);

Words error_words(const Error& error);
/// Returns the error that the words describe.
Error error_of(const Words& words);

}  // namespace tactus::hosted
