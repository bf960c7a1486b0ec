// SPDX-License-Identifier: Apache-2.0
// What an engine and a device's process say to each other while a device is opened: lists of words over a socket of
// packets. Once the device runs, only that the socket is closed says something.
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

/// Throws Error when the words are too many bytes. A socket that is closed is noticed by `receive`.
void send(int socket, const Words& words);

struct Received {
    enum Kind { words, nothing, closed } kind = nothing;
    Words said;
};
/// Waits at most so long; without a time, for ever. What is no list of words counts as closed.
Received receive(int socket, std::optional<std::chrono::milliseconds> longest);

// The first word says what it is.
inline constexpr const char* say_open =
    "open";  ///< driver, owner, place, then name, text, scope and place of each option
inline constexpr const char* say_resolve = "resolve";  ///< name of an asset; answered by `path` or `error`
inline constexpr const char* say_path = "path";
inline constexpr const char* say_ready = "ready";
inline constexpr const char* say_prepare = "prepare";  ///< tick period in s, as a hexadecimal number
inline constexpr const char* say_prepared = "prepared";
inline constexpr const char* say_error = "error";  ///< place, message

/// File, line and column, as three words.
void append(Words& words, const SourceLocation& where);
/// Throws Error when they are not there.
SourceLocation take_location(std::span<const std::string>& words);

Words error_words(const Error& error);
/// The error that those words tell of.
Error error_of(const Words& words);

}  // namespace tactus::hosted
