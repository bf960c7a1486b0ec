// SPDX-License-Identifier: Apache-2.0
// How a client and a server of a WebSocket agree to speak it (RFC 6455, section 4).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace tactus::haply {

/// SHA-1 (FIPS 180-4), for the handshake alone: it protects nothing.
std::array<std::uint8_t, 20> sha1(std::string_view text);

/// Another one for each connection: 16 random bytes in Base64.
std::string handshake_key();

/// What a server answers to that key: its Sec-WebSocket-Accept.
std::string accept_for(std::string_view key);

/// The greeting of a client.
std::string greeting(std::string_view host, int port, std::string_view key);

/// Why `answer`, which ends with an empty line, does not open the connection that was asked for; empty: it does.
std::string refusal(std::string_view answer, std::string_view key);

}  // namespace tactus::haply
