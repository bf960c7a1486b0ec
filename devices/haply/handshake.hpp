// SPDX-License-Identifier: Apache-2.0
// The opening handshake of a WebSocket (RFC 6455, section 4).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace tactus::haply {

/// SHA-1 (FIPS 180-4), for the handshake only; it protects nothing.
std::array<std::uint8_t, 20> sha1(std::string_view text);

/// Returns a new key for each connection: 16 random bytes in Base64.
std::string handshake_key();

/// Returns the server's answer to that key: its Sec-WebSocket-Accept.
std::string accept_for(std::string_view key);

/// Returns the opening request of a client.
std::string greeting(std::string_view host, int port, std::string_view key);

/// Returns the reason why `answer`, which ends with an empty line, does not open the requested connection; empty if it
/// does.
std::string refusal(std::string_view answer, std::string_view key);

}  // namespace tactus::haply
