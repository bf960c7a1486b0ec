// SPDX-License-Identifier: Apache-2.0
// Running 64-bit hash over the samples of a signal: vector instructions hash a block of samples, and any partition into
// blocks gives the same value.
#pragma once

#include "dsp/core/hash.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tactus {

/// Adds a key to the raw bits of each sample, multiplies pairs to 64 bits and sums 256 samples (NH, Black et al. 1999,
/// the core of UMAC); the sums are chained. Integer sums do not depend on the order, so vector lanes may be added in
/// any order.
struct SignalHash {
    static constexpr std::size_t window = 256;
    using Keys = std::array<std::uint32_t, window>;

    std::uint64_t chain = Hash{}.state;
    std::uint64_t sum = 0;
    std::uint32_t first_of_pair = 0;

    /// Adds the sample number `position`. Wait-free.
    void add(std::uint64_t position, float sample) noexcept {
        const std::size_t at = position % window;
        const std::uint32_t keyed = std::bit_cast<std::uint32_t>(sample) + keys[at];
        if (at % 2 == 0) {
            first_of_pair = keyed;
            return;
        }
        sum += std::uint64_t{first_of_pair} * keyed;
        if (at == window - 1) close();
    }
    /// Adds `count` samples from number `position` on. Wait-free.
    void add(std::uint64_t position, const float* samples, std::size_t count) noexcept;

    /// Hash of all `position` samples so far.
    std::uint64_t value(std::uint64_t position) const noexcept {
        Hash all{chain};
        all.add_word(sum);
        all.add_word(position % 2 == 1 ? first_of_pair : 0);
        all.add_word(position);
        return all.value();
    }

private:
    void close() noexcept {
        Hash next{chain};
        next.add_word(sum);
        chain = next.state;
        sum = 0;
    }

    alignas(16) static constexpr Keys keys = [] {
        Keys all{};
        for (std::size_t i = 0; i < window; ++i) all[i] = static_cast<std::uint32_t>(mix(i));
        return all;
    }();
};

}  // namespace tactus
