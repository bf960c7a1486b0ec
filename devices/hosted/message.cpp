// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/message.hpp"

#include "dsp/core/clock.hpp"

#include <fmt/format.h>

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>

namespace tactus::hosted {

namespace {

std::optional<Words> unpack(std::span<const char> bytes) {
    Words words;
    while (!bytes.empty()) {
        std::uint32_t size = 0;
        if (bytes.size() < sizeof size) return std::nullopt;
        std::memcpy(&size, bytes.data(), sizeof size);
        bytes = bytes.subspan(sizeof size);
        if (bytes.size() < size) return std::nullopt;
        words.emplace_back(bytes.data(), size);
        bytes = bytes.subspan(size);
    }
    return words;
}

int line_number_of(const std::string& word) {
    try {
        return std::stoi(word);
    } catch (const std::exception&) {
        throw Error("a message of the device's process has no place");
    }
}

}  // namespace

void send(int socket, const Words& words) {
    std::string bytes;
    for (const std::string& word : words) {
        const auto size = static_cast<std::uint32_t>(std::min(word.size(), longest_message));
        bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
        bytes.append(word, 0, size);
        if (bytes.size() > longest_message)
            throw Error(
                fmt::format("the options of a device with a process of its own are at most {} bytes; put long "
                            "ones in a file",
                            longest_message));
    }
    while (::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL) < 0 && errno == EINTR) {
    }
}

Received receive(int socket, std::optional<std::chrono::milliseconds> longest) {
    const std::int64_t until =
        steady_ns() + std::chrono::nanoseconds(longest.value_or(std::chrono::milliseconds(0))).count();
    for (;;) {
        pollfd one{socket, POLLIN, 0};
        const int ready = ::poll(&one, 1, longest ? ms_until(until) : -1);
        if (ready < 0 && errno == EINTR) continue;
        if (ready <= 0) return {ready == 0 ? Received::nothing : Received::closed, {}};
        std::vector<char> bytes(longest_message);  // only now: a driver's thread asks each round
        const ssize_t count = ::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (count <= 0) return {Received::closed, {}};
        std::optional<Words> words = unpack({bytes.data(), static_cast<std::size_t>(count)});
        if (!words || words->empty()) return {Received::closed, {}};
        return {Received::words, std::move(*words)};
    }
}

void append(Words& words, const SourceLocation& where) {
    words.push_back(where.file);
    words.push_back(std::to_string(where.line));
    words.push_back(std::to_string(where.column));
}

SourceLocation take_location(std::span<const std::string>& words) {
    if (words.size() < 3) throw Error("a message of the device's process has no place");
    SourceLocation where{words[0], line_number_of(words[1]), line_number_of(words[2])};
    words = words.subspan(3);
    return where;
}

Words error_words(const Error& error) {
    constexpr std::size_t longest_text = 4096;
    Words words{say_error};
    append(words, error.where());
    words.push_back(error.message().substr(0, longest_text));
    return words;
}

Error error_of(const Words& words) {
    std::span<const std::string> rest = words;
    rest = rest.subspan(1);
    SourceLocation where = take_location(rest);
    const std::string message = rest.empty() ? "the driver failed" : rest.front();
    return where.file.empty() ? Error(message) : Error(std::move(where), message);
}

}  // namespace tactus::hosted
