// SPDX-License-Identifier: Apache-2.0
// What a server answers to the greeting of a WebSocket: only one answer opens it, the one to the key that was sent.
#include "devices/haply/handshake.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tactus::haply;
    static const std::string key = "dGhlIHNhbXBsZSBub25jZQ==", accept = accept_for(key);
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    // An answer that lacks the word that only this key has opens nothing.
    if (refusal(bytes, key).empty() && bytes.find(accept) == std::string_view::npos) std::abort();
    // Another key has another word.
    if (refusal(bytes, "x3JJHMbDL1EzLkh9GBhXDw==").empty() && bytes.find(accept) != std::string_view::npos &&
        bytes.find(accept_for("x3JJHMbDL1EzLkh9GBhXDw==")) == std::string_view::npos)
        std::abort();
    if (sha1(bytes) != sha1(std::string(bytes)) || accept_for(bytes).size() != 28) std::abort();
    const std::string asked = greeting(bytes, static_cast<int>(size), key);
    if (asked.find("\r\n\r\n") == std::string::npos) std::abort();
    return 0;
}
