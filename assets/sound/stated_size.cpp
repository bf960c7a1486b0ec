// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/stated_size.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <span>
#include <string_view>

namespace tactus::sound {

namespace {

using Head = std::array<char, 24>;

std::uint64_t big_number(std::span<const char> bytes) {
    std::uint64_t number = 0;
    for (const char byte : bytes) number = number << 8 | static_cast<unsigned char>(byte);
    return number;
}

std::uint64_t small_number(std::span<const char> bytes) {
    std::uint64_t number = 0;
    for (std::size_t n = bytes.size(); n-- > 0;) number = number << 8 | static_cast<unsigned char>(bytes[n]);
    return number;
}

/// A chunk of an AIFF at `at`: a printable name and a size that fits.
bool is_aiff_chunk(std::ifstream& file, std::uint64_t at, std::uint64_t size) {
    std::array<char, 8> chunk{};
    file.clear();
    if (!file.seekg(static_cast<std::streamoff>(at)) || !file.read(chunk.data(), chunk.size())) return false;
    return std::ranges::all_of(std::span(chunk).first(4), [](char c) { return c >= ' ' && c < 127; }) &&
           at + 8 + big_number(std::span(chunk).subspan(4)) <= size + 1;
}

/// The end of the samples of an AIFF. The size of the whole is not used: writers state it wrongly by some bytes.
std::optional<std::uint64_t> end_of_aiff(std::ifstream& file) {
    std::uint64_t at = 12;
    std::array<char, 8> chunk{};
    while (file.seekg(static_cast<std::streamoff>(at)) && file.read(chunk.data(), chunk.size())) {
        const std::uint64_t size = big_number(std::span(chunk).subspan(4));
        at += chunk.size() + size;
        if (std::string_view(chunk.data(), 4) == "SSND") return at;
        at += size % 2;
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::uint64_t> stated_size(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    Head head{};
    if (!file.read(head.data(), head.size())) return std::nullopt;
    const std::string_view mark(head.data(), 4), kind(head.data() + 8, 4);
    const std::span bytes(head);
    if (mark == "FORM" && (kind == "AIFF" || kind == "AIFC")) return end_of_aiff(file);
    if (mark == "riff") return small_number(bytes.subspan(16, 8));
    if (mark == ".snd" || mark == "dns.") {
        const auto number = mark == ".snd" ? big_number : small_number;
        const std::uint64_t start = number(bytes.subspan(4, 4)), size = number(bytes.subspan(8, 4));
        return size == 0xffffffff ? std::nullopt : std::optional(start + size);
    }
    return std::nullopt;
}

std::uint64_t unread_bytes(const std::filesystem::path& path, std::uint64_t size) {
    constexpr std::uint64_t least = 8;  // writers align their files
    const std::optional<std::uint64_t> end = stated_size(path);
    if (!end || *end + least > size) return 0;
    std::ifstream file(path, std::ios::binary);
    std::array<char, 4> mark{};
    file.read(mark.data(), mark.size());
    // Chunks may follow the samples of an AIFF.
    if (std::string_view(mark.data(), mark.size()) == "FORM")
        for (const std::uint64_t at : {*end + *end % 2, *end})
            if (is_aiff_chunk(file, at, size)) return 0;
    return size - *end;
}

}  // namespace tactus::sound
