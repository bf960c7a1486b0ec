// SPDX-License-Identifier: Apache-2.0
// The client's side of a WebSocket (RFC 6455) to a service on this machine: text messages, no extensions, no encryption.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tactus::haply {

/// Longest message that is taken; a longer one is an error.
inline constexpr std::size_t longest_message = 64 * 1024;

/// Puts messages together from frames of a server that arrive in any pieces.
class MessageReader {
public:
    enum class Found { nothing, message, ping, closed, broken };

    /// Adds received bytes. Broken for ever when more than a message and a half waits.
    void add(std::span<const char> bytes);
    /// The next of what was received. After `message` and `ping`, `text` has it. `broken`: not by the RFC, or too long.
    Found next();
    const std::string& text() const { return text_; }

private:
    Found fail();

    std::string bytes_, text_, parts_;
    bool in_parts_ = false, is_broken_ = false;
};

/// A frame of a client with all of `text`, masked by `key`. `opcode`: 1 text, 8 close, 10 pong.
std::string client_frame(int opcode, std::string_view text, std::uint32_t key);

class WebSocket {
public:
    WebSocket() = default;
    ~WebSocket() { close(); }
    WebSocket(const WebSocket&) = delete;
    WebSocket& operator=(const WebSocket&) = delete;

    /// Connects and shakes hands, within `longest` in all. Throws Error.
    void open(const std::string& host, int port, std::chrono::milliseconds longest);
    void close() noexcept;
    /// False when the peer is gone or takes nothing.
    bool send(std::string_view text);

    enum class Heard { nothing, message, closed };
    /// Waits at most `longest` for a message, which `text` then has.
    Heard receive(std::chrono::milliseconds longest);
    const std::string& text() const { return reader_.text(); }

private:
    bool write_all(std::string_view bytes, std::chrono::milliseconds longest);

    int file_ = -1;
    std::uint32_t key_ = 0x9E3779B9u;
    MessageReader reader_;
};

}  // namespace tactus::haply
