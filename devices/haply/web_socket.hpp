// SPDX-License-Identifier: Apache-2.0
// The client side of a WebSocket (RFC 6455) to a service on this machine: text messages, no extensions, no encryption.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tactus::haply {

/// Longest accepted message; a longer one is an error.
inline constexpr std::size_t longest_message = 64 * 1024;

/// Assembles messages from the frames of a server, which may arrive in any pieces.
class MessageReader {
public:
    enum class Found { nothing, message, ping, closed, broken };

    /// Adds received bytes. The reader becomes broken permanently if more than one and a half messages are pending.
    void add(std::span<const char> bytes);
    /// Returns the next received item. After `message` and `ping`, `text` contains it. `broken`: invalid by the RFC, or
    /// too long.
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

    /// Connects and performs the handshake, within `longest` in total. Throws Error.
    void open(const std::string& host, int port, std::chrono::milliseconds longest);
    void close() noexcept;
    /// Returns false if the connection is closed or accepts nothing.
    bool send(std::string_view text);

    enum class Heard { nothing, message, closed };
    /// Waits at most `longest` for a message and stores it in `text`.
    Heard receive(std::chrono::milliseconds longest);
    const std::string& text() const { return reader_.text(); }

private:
    bool write_all(std::string_view bytes, std::chrono::milliseconds longest);

    int file_ = -1;
    std::uint32_t key_ = 0x9E3779B9u;
    MessageReader reader_;
};

}  // namespace tactus::haply
