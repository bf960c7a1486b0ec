// SPDX-License-Identifier: Apache-2.0
#include "devices/haply/web_socket.hpp"

#include "devices/haply/handshake.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace tactus::haply {

namespace {

using std::chrono::milliseconds;

constexpr std::size_t longest_greeting = 8 * 1024;

std::int64_t after(milliseconds time) { return steady_ns() + std::chrono::nanoseconds(time).count(); }

bool wait_for(int file, short what, int longest_ms) {
    pollfd one{file, what, 0};
    return ::poll(&one, 1, longest_ms) > 0;
}

}  // namespace

void MessageReader::add(std::span<const char> bytes) {
    if (bytes_.size() + bytes.size() > longest_message + longest_message / 2) is_broken_ = true;
    else bytes_.append(bytes.data(), bytes.size());
}

MessageReader::Found MessageReader::fail() {
    is_broken_ = true;
    return Found::broken;
}

MessageReader::Found MessageReader::next() {
    for (;;) {
        if (is_broken_) return Found::broken;
        if (bytes_.size() < 2) return Found::nothing;
        const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes_[i]); };
        const bool is_last = (byte(0) & 0x80) != 0;
        const int opcode = byte(0) & 0x0F;
        // No extension was agreed on, and a server does not mask.
        if ((byte(0) & 0x70) != 0 || (byte(1) & 0x80) != 0) return fail();
        std::uint64_t size = byte(1) & 0x7F;
        std::size_t head = 2;
        if (size >= 126) {
            const std::size_t more = size == 126 ? 2 : 8;
            if (bytes_.size() < 2 + more) return Found::nothing;
            size = 0;
            for (std::size_t i = 0; i < more; ++i) size = size << 8 | byte(2 + i);
            head += more;
        }
        if (size > longest_message) return fail();
        if (opcode >= 8 && (!is_last || size > 125)) return fail();
        if (bytes_.size() < head + size) return Found::nothing;
        const std::string payload = bytes_.substr(head, size);
        bytes_.erase(0, head + size);
        if (opcode == 8) return Found::closed;
        if (opcode == 9) {
            text_ = payload;
            return Found::ping;
        }
        if (opcode == 10) continue;
        if (opcode > 2 || (opcode == 0) != in_parts_) return fail();
        if (parts_.size() + payload.size() > longest_message) return fail();
        parts_ += payload;
        in_parts_ = !is_last;
        if (!is_last) continue;
        text_ = std::exchange(parts_, {});
        return Found::message;
    }
}

std::string client_frame(int opcode, std::string_view text, std::uint32_t key) {
    std::string frame;
    frame += static_cast<char>(0x80 | opcode);
    if (text.size() < 126) frame += static_cast<char>(0x80 | text.size());
    else {
        const int bytes = text.size() < 65536 ? 2 : 8;
        frame += static_cast<char>(0x80 | (bytes == 2 ? 126 : 127));
        for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>(text.size() >> (8 * i));
    }
    char mask[4];
    std::memcpy(mask, &key, sizeof mask);
    frame.append(mask, sizeof mask);
    for (std::size_t i = 0; i < text.size(); ++i) frame += static_cast<char>(text[i] ^ mask[i % 4]);
    return frame;
}

void WebSocket::open(const std::string& host, int port, milliseconds longest) {
    close();
    reader_ = {};
    const std::int64_t until = after(longest);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    if (::inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1)
        throw Error(fmt::format("'{}' is no address such as 127.0.0.1", host));
    file_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const auto fail = [&](const std::string& why) {
        close();
        throw Error(fmt::format("no service at {}:{}: {}", host, port, why));
    };
    const int at_once = 1;
    ::setsockopt(file_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    if (::connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
        if (errno != EINPROGRESS) fail(std::strerror(errno));
        if (!wait_for(file_, POLLOUT, ms_until(until))) fail("no answer");
        int failure = 0;
        socklen_t size = sizeof failure;
        ::getsockopt(file_, SOL_SOCKET, SO_ERROR, &failure, &size);
        if (failure != 0) fail(std::strerror(failure));
    }
    const std::string key = handshake_key(), hello = greeting(host, port, key);
    if (!write_all(hello, milliseconds(ms_until(until)))) fail("it takes no greeting");
    std::string answer;
    std::size_t end = std::string::npos;
    while (end == std::string::npos) {
        if (!wait_for(file_, POLLIN, ms_until(until))) fail("it does not answer a WebSocket's greeting");
        std::array<char, 512> bytes;
        const ssize_t count = ::recv(file_, bytes.data(), bytes.size(), 0);
        if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) fail("it hung up");
        if (count > 0) answer.append(bytes.data(), static_cast<std::size_t>(count));
        if (answer.size() > longest_greeting) fail("its answer does not end");
        end = answer.find("\r\n\r\n");
    }
    if (const std::string why = refusal(std::string_view(answer).substr(0, end + 2), key); !why.empty()) fail(why);
    reader_.add({answer.data() + end + 4, answer.size() - end - 4});
}

void WebSocket::close() noexcept {
    if (file_ >= 0) ::close(std::exchange(file_, -1));
}

bool WebSocket::write_all(std::string_view bytes, milliseconds longest) {
    const std::int64_t until = after(longest);
    while (!bytes.empty()) {
        const ssize_t count = ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
        else if (count < 0 && errno != EAGAIN && errno != EINTR) return false;
        else if (!wait_for(file_, POLLOUT, ms_until(until))) return false;
    }
    return true;
}

bool WebSocket::send(std::string_view text) {
    key_ = key_ * 1664525u + 1013904223u;
    return write_all(client_frame(1, text, key_), milliseconds(5));
}

WebSocket::Heard WebSocket::receive(milliseconds longest) {
    const std::int64_t until = after(longest);
    // The bound is for a peer that floods with pings.
    for (int turns = 0; turns < 64; ++turns) {
        switch (reader_.next()) {
            case MessageReader::Found::message: return Heard::message;
            case MessageReader::Found::ping:
                if (!write_all(client_frame(10, reader_.text(), key_), milliseconds(5))) return Heard::closed;
                continue;
            case MessageReader::Found::closed:
            case MessageReader::Found::broken: return Heard::closed;
            case MessageReader::Found::nothing: break;
        }
        if (!wait_for(file_, POLLIN, ms_until(until))) return Heard::nothing;
        std::array<char, 4096> bytes;
        const ssize_t count = ::recv(file_, bytes.data(), bytes.size(), 0);
        if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) return Heard::closed;
        if (count > 0) reader_.add({bytes.data(), static_cast<std::size_t>(count)});
    }
    return Heard::nothing;
}

}  // namespace tactus::haply
