// SPDX-License-Identifier: Apache-2.0
// Running 64-bit hash over raw bits; order-dependent, fast, not cryptographic.
#pragma once

#include "dsp/core/random.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace tactus {

struct Hash {
    std::uint64_t state = 0x243f6a8885a308d3ULL;

    void add_word(std::uint64_t word) {
        state = (state ^ word) * 0x9fb21c651e98df25ULL;
        state ^= state >> 32;
    }
    void add_bytes(const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (; size >= 8; bytes += 8, size -= 8) {
            std::uint64_t word;
            std::memcpy(&word, bytes, 8);
            add_word(word);
        }
        if (size > 0) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes, size);
            add_word(word ^ (static_cast<std::uint64_t>(size) << 56));
        }
    }
    void add_text(std::string_view text) {
        add_bytes(text.data(), text.size());
        add_word(text.size());
    }
    std::uint64_t value() const { return mix(state); }
};

}  // namespace tactus
