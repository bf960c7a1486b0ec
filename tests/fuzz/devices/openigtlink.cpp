// SPDX-License-Identifier: Apache-2.0
#include "devices/openigtlink/message.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

/// Gives the first message of the input the right checksum, so that its content is read.
static std::vector<std::uint8_t> summed(std::span<const std::uint8_t> data) {
    std::vector<std::uint8_t> bytes(data.begin(), data.end());
    if (bytes.size() < 58) return bytes;
    std::uint64_t size = 0;
    for (std::size_t i = 42; i < 50; ++i) size = size << 8 | bytes[i];
    const auto body = std::span(bytes).subspan(58, std::min<std::uint64_t>(size, bytes.size() - 58));
    const std::uint64_t sum = tactus::openigtlink::crc64(body);
    for (std::size_t i = 0; i < 8; ++i) bytes[50 + i] = static_cast<std::uint8_t>(sum >> (56 - 8 * i));
    return bytes;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tactus::openigtlink;
    const std::vector<std::uint8_t> bytes = summed({data, size});
    MessageReader whole, pieces;
    whole.take(bytes);
    int messages = 0, again = 0;
    while (const auto message = whole.next()) {
        ++messages;
        if (const auto pose = pose_in(*message, ""); pose && !tactus::is_valid(*pose)) std::abort();
    }
    for (const std::uint8_t byte : bytes) {
        pieces.take({&byte, 1});
        while (pieces.next()) ++again;
    }
    if (messages != again || whole.is_broken() != pieces.is_broken()) std::abort();
    return 0;
}
