// SPDX-License-Identifier: Apache-2.0
#include "devices/haply/handshake.hpp"

#include "dsp/core/lower.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <random>
#include <span>

namespace tactus::haply {

namespace {

std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k < bytes.size() + 1 ? letters[three >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

/// The value of a header, without the blanks around it; empty when there is none.
std::string_view header(std::string_view answer, std::string_view name) {
    for (std::size_t at = answer.find("\r\n"); at != std::string_view::npos; at = answer.find("\r\n", at)) {
        at += 2;
        const std::string_view line = answer.substr(at, answer.find("\r\n", at) - at);
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos || lower(line.substr(0, colon)) != name) continue;
        std::string_view value = line.substr(colon + 1);
        while (!value.empty() && (value.front() == ' ' || value.front() == '\t')) value.remove_prefix(1);
        while (!value.empty() && (value.back() == ' ' || value.back() == '\t')) value.remove_suffix(1);
        return value;
    }
    return {};
}

}  // namespace

std::array<std::uint8_t, 20> sha1(std::string_view text) {
    std::string padded(text);
    padded += '\x80';
    while (padded.size() % 64 != 56) padded += '\0';
    const std::uint64_t bits = 8 * static_cast<std::uint64_t>(text.size());
    for (int i = 7; i >= 0; --i) padded += static_cast<char>(bits >> (8 * i));
    std::array<std::uint32_t, 5> h{0x67452301u, 0xEFCDAB89u, 0x98BADCFEu, 0x10325476u, 0xC3D2E1F0u};
    for (std::size_t block = 0; block < padded.size(); block += 64) {
        std::array<std::uint32_t, 80> w{};
        for (std::size_t i = 0; i < 64; ++i) w[i / 4] = w[i / 4] << 8 | static_cast<std::uint8_t>(padded[block + i]);
        for (std::size_t i = 16; i < 80; ++i) w[i] = std::rotl(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
        auto [a, b, c, d, e] = h;
        for (std::size_t i = 0; i < 80; ++i) {
            const std::uint32_t f = i < 20   ? (b & c) | (~b & d)
                                    : i < 40 ? b ^ c ^ d
                                    : i < 60 ? (b & c) | (b & d) | (c & d)
                                             : b ^ c ^ d;
            constexpr std::array<std::uint32_t, 4> k{0x5A827999u, 0x6ED9EBA1u, 0x8F1BBCDCu, 0xCA62C1D6u};
            const std::uint32_t next = std::rotl(a, 5) + f + e + k[i / 20] + w[i];
            e = d;
            d = c;
            c = std::rotl(b, 30);
            b = a;
            a = next;
        }
        h = {h[0] + a, h[1] + b, h[2] + c, h[3] + d, h[4] + e};
    }
    std::array<std::uint8_t, 20> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(h[i / 4] >> (24 - 8 * (i % 4)));
    return bytes;
}

std::string handshake_key() {
    std::random_device random;
    std::array<std::uint8_t, 16> bytes{};
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return base64(bytes);
}

std::string accept_for(std::string_view key) {
    return base64(sha1(std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"));
}

std::string greeting(std::string_view host, int port, std::string_view key) {
    return fmt::format(
        "GET / HTTP/1.1\r\nHost: {}:{}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: {}\r\nSec-WebSocket-Version: 13\r\n\r\n",
        host, port, key);
}

std::string refusal(std::string_view answer, std::string_view key) {
    const std::string_view first = answer.substr(0, answer.find("\r\n"));
    if (!first.starts_with("HTTP/1.1 101")) return fmt::format("it answers '{}'", first.substr(0, 100));
    if (lower(header(answer, "upgrade")) != "websocket" ||
        lower(header(answer, "connection")).find("upgrade") == std::string::npos)
        return "its answer opens no WebSocket";
    if (header(answer, "sec-websocket-accept") != accept_for(key))
        return "it answers another greeting (Sec-WebSocket-Accept is wrong)";
    if (!header(answer, "sec-websocket-extensions").empty() || !header(answer, "sec-websocket-protocol").empty())
        return "it requires an extension that was not requested";
    return {};
}

}  // namespace tactus::haply
