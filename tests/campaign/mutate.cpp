// SPDX-License-Identifier: Apache-2.0
#include "tests/campaign/mutate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace tactus::campaign {

namespace {

// Heads decide most; of large files with long runs of zeros, what is not zero.
std::size_t place_in(const std::string& bytes, Dice& dice) {
    switch (dice.below(4)) {
        case 0: return dice.below(bytes.size());
        case 1: return dice.below(std::min<std::size_t>(bytes.size(), 64));
        case 2: return dice.below(std::min<std::size_t>(bytes.size(), 1024));
        default: {
            std::size_t at = dice.below(bytes.size());
            for (std::size_t n = 0; n < bytes.size() && bytes[at] == '\0'; ++n) at = (at + 1) % bytes.size();
            return at;
        }
    }
}

std::string flip(std::string& bytes, Dice& dice) {
    const std::size_t count = 1 + dice.below(4), at = place_in(bytes, dice);
    for (std::size_t n = 0; n < count && at + n < bytes.size(); ++n) bytes[at + n] = static_cast<char>(dice.next());
    return fmt::format("{} bytes at {}", count, at);
}

std::string cut(std::string& bytes, Dice& dice) {
    bytes.resize(dice.below(2) == 0 ? dice.below(bytes.size())
                                    : bytes.size() - dice.below(std::min<std::size_t>(bytes.size(), 64)));
    return fmt::format("cut to {}", bytes.size());
}

std::string write_number(std::string& bytes, Dice& dice) {
    constexpr std::array<std::int64_t, 18> numbers{
        0,         1,          -1,         -2,         127,        255,        32767,     65535,     -32768,
        1'000'000, -1'000'000, 0x3fffffff, 0x7fffffff, 0x80000000, 0xffffffff, INT64_MAX, INT64_MIN, -4096};
    const std::size_t size = std::size_t{1} << dice.below(4), at = place_in(bytes, dice);
    if (at + size > bytes.size()) return flip(bytes, dice);
    std::int64_t number = 0;
    if (dice.below(3) == 0) {  // nearly what was there
        std::memcpy(&number, &bytes[at], size);
        number += static_cast<std::int64_t>(dice.below(33)) - 16;
        if (dice.below(4) == 0) number = -number;
        if (dice.below(4) == 0) number *= 2;
    } else {
        number = numbers[dice.below(numbers.size())];
    }
    std::array<char, 8> raw;
    std::memcpy(raw.data(), &number, sizeof number);
    const bool is_swapped = dice.below(4) == 0;
    if (is_swapped) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    std::memcpy(&bytes[at], raw.data(), size);
    return fmt::format("{} in {} bytes{} at {}", number, size, is_swapped ? ", swapped," : "", at);
}

std::string move_pieces(std::string& bytes, Dice& dice) {
    const std::size_t size = 1 + dice.below(std::min<std::size_t>(bytes.size() / 2, std::size_t{1} << dice.below(14)));
    const std::size_t from = place_in(bytes, dice), to = place_in(bytes, dice);
    const std::string piece = bytes.substr(from, size);
    switch (dice.below(3)) {
        case 0: bytes.erase(from, size); return fmt::format("{} bytes at {} taken out", size, from);
        case 1: bytes.insert(to, piece); return fmt::format("{} bytes of {} put in at {}", size, from, to);
        default: {
            const std::string other = bytes.substr(to, piece.size());
            bytes.replace(to, other.size(), piece);
            bytes.replace(std::min(from, bytes.size()), piece.size(), other);
            return fmt::format("{} bytes at {} and {} swapped", size, from, to);
        }
    }
}

std::string write_text_number(std::string& bytes, Dice& dice) {
    constexpr std::array<std::string_view, 14> numbers{
        "-1",         "0",          "1e308",  "-1e308", "nan",   "inf",         "99999999999999999999999",
        "4294967295", "2147483648", "1e-320", "1e9",    "65536", "-2147483648", "0x7fffffff"};
    std::size_t at = bytes.find_first_of("0123456789", place_in(bytes, dice));
    if (at == std::string::npos) at = bytes.find_first_of("0123456789");
    if (at == std::string::npos) return flip(bytes, dice);
    const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", at), bytes.size());
    const std::string_view number = numbers[dice.below(numbers.size())];
    bytes.replace(at, end - at, number);
    return fmt::format("{} at {}", number, at);
}

std::string lengthen(std::string& bytes, Dice& dice) {
    constexpr std::string_view letters = "a1 \t(,\"[{.-\\0";
    std::size_t at = place_in(bytes, dice);
    // Behind what begins a value, when there is such a thing.
    if (const std::size_t value = bytes.find_first_of(":= ,(\"", at); dice.below(2) == 0 && value != std::string::npos)
        at = value + 1;
    const std::size_t size = std::size_t{1} << (6 + dice.below(15));
    const char letter = letters[dice.below(letters.size())];
    bytes.insert(at, std::string(size, letter));
    return fmt::format("{} times '{}' at {}", size, letter, at);
}

}  // namespace

std::uint64_t Dice::next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

std::size_t Dice::below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(next() % count); }

std::string mutate(std::string& bytes, Dice& dice) {
    constexpr std::array steps{flip,         cut,         write_number,      write_number,
                               write_number, move_pieces, write_text_number, write_text_number,
                               lengthen};
    std::string done;
    for (std::size_t left = 1 + dice.below(3); left > 0 && !bytes.empty(); --left)
        done += (done.empty() ? "" : "; ") + steps[dice.below(steps.size())](bytes, dice);
    return done;
}

}  // namespace tactus::campaign
