// SPDX-License-Identifier: Apache-2.0
// What breaks a file, decided by a number alone.
#pragma once

#include <cstdint>
#include <string>

namespace tactus::campaign {

/// Numbers that depend on the seed alone (SplitMix64).
class Dice {
public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next();
    /// 0 … count - 1; 0 when `count` is 0.
    std::size_t below(std::size_t count);

private:
    std::uint64_t state_;
};

/// One to three of: bytes flipped, the end cut off, a whole number (huge, negative, nearly right) written over others,
/// pieces swapped, repeated or taken out, a number in text replaced, a long line. Returns what was done, in words.
std::string mutate(std::string& bytes, Dice& dice);

}  // namespace tactus::campaign
