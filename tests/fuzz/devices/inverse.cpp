// SPDX-License-Identifier: Apache-2.0
// Haply's service: frames of a WebSocket, whole and byte by byte, and the texts in them.
#include "devices/haply/inverse_messages.hpp"
#include "devices/haply/web_socket.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>

namespace {

using tactus::haply::MessageReader;

/// All that a reader finds, as text.
std::string all_of(MessageReader& reader) {
    std::string all;
    for (;;) {
        const MessageReader::Found found = reader.next();
        all += static_cast<char>('0' + static_cast<int>(found));
        if (found == MessageReader::Found::message || found == MessageReader::Found::ping) {
            if (reader.text().size() > tactus::haply::longest_message) std::abort();
            all += reader.text();
            if (found == MessageReader::Found::message) tactus::haply::read_inverse(reader.text());
        } else return all;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const char* const bytes = reinterpret_cast<const char*>(data);
    tactus::haply::read_inverse({bytes, size});
    MessageReader whole;
    whole.add({bytes, size});
    all_of(whole);
    MessageReader pieces;
    for (std::size_t i = 0; i < size; ++i) {
        pieces.add({bytes + i, 1});
        all_of(pieces);
    }
    return 0;
}
