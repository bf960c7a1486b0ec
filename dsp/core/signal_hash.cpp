// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/signal_hash.hpp"

#include <algorithm>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace tactus {

namespace {

/// Sum over `count` samples, a multiple of 4, with keys from an even index on.
std::uint64_t sum_of_pairs(const float* samples, const std::uint32_t* keys, std::size_t count) noexcept {
#if defined(__SSE2__)
    __m128i total = _mm_setzero_si128();
    for (std::size_t i = 0; i < count; i += 4) {
        const __m128i bits = _mm_castps_si128(_mm_loadu_ps(samples + i));
        const __m128i key = _mm_loadu_si128(reinterpret_cast<const __m128i*>(keys + i));
        const __m128i keyed = _mm_add_epi32(bits, key);
        total = _mm_add_epi64(total, _mm_mul_epu32(keyed, _mm_srli_epi64(keyed, 32)));
    }
    alignas(16) std::uint64_t lanes[2];
    _mm_store_si128(reinterpret_cast<__m128i*>(lanes), total);
    return lanes[0] + lanes[1];
#else
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < count; i += 2)
        total += std::uint64_t{std::bit_cast<std::uint32_t>(samples[i]) + keys[i]} *
                 (std::bit_cast<std::uint32_t>(samples[i + 1]) + keys[i + 1]);
    return total;
#endif
}

}  // namespace

void SignalHash::add(std::uint64_t position, const float* samples, std::size_t count) noexcept {
    while (count > 0) {
        const std::size_t at = position % window, whole = std::min(count, window - at) & ~std::size_t{3};
        if (at % 2 == 1 || whole == 0) {
            add(position++, *samples++);
            --count;
            continue;
        }
        sum += sum_of_pairs(samples, keys.data() + at, whole);
        if (at + whole == window) close();
        position += whole;
        samples += whole;
        count -= whole;
    }
}

}  // namespace tactus
