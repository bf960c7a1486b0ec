// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/wave_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>

namespace tactus::sound {

namespace {

constexpr std::uint64_t max_kept = 1 << 20;  // bytes of a chunk that is kept

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint64_t number = 0;
    for (std::size_t n = 0; n < size; ++n)
        number |= std::uint64_t{static_cast<unsigned char>(bytes[at + n])} << (8 * n);
    return number;
}

void put(std::string& out, std::uint64_t number, std::size_t size) {
    for (std::size_t n = 0; n < size; ++n) out += static_cast<char>(number >> (8 * n) & 0xff);
}

void put_chunk(std::string& out, std::string_view name, std::string_view bytes) {
    out += name;
    put(out, bytes.size(), 4);
    out += bytes;
    if (bytes.size() % 2 != 0) out += '\0';
}

bool is_chunk_name(std::string_view name) {
    return std::ranges::all_of(name, [](char c) { return c >= ' ' && c < 127; });
}

bool is_known_chunk(std::string_view name) {
    constexpr std::array<std::string_view, 6> known{"fmt ", "data", "LIST", "fact", "PEAK", "bext"};
    return std::ranges::find(known, name) != known.end();
}

/// Tags that players append to a file, without the size of a chunk.
bool is_tag(std::string_view bytes) {
    return bytes.starts_with("TAG") || bytes.starts_with("ID3") || bytes.starts_with("APETAGEX");
}

/// Of the bytes behind the samples: a chunk with a name, which fits into the file or has a known name, or a tag.
bool is_behind_samples(std::string_view head, std::uint64_t left) {
    if (head.size() < 8) return true;
    const std::string_view name = head.substr(0, 4);
    return is_tag(head) || is_known_chunk(name) || (is_chunk_name(name) && number_at(head, 4, 4) + 8 <= left + 1);
}

}  // namespace

std::optional<WaveHeader> repaired_wave_header(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::error_code failure;
    const std::uint64_t present = std::filesystem::file_size(path, failure);
    std::string head(12, '\0');
    if (failure || !file.read(head.data(), 12)) return std::nullopt;
    const bool is_rf64 = head.starts_with("RF64") || head.starts_with("BW64");
    if ((!head.starts_with("RIFF") && !is_rf64) || head.substr(8) != "WAVE") return std::nullopt;
    const std::uint64_t stated = number_at(head, 4, 4);
    const auto read = [&](std::uint64_t at, std::uint64_t size) {
        std::string bytes(size, '\0');
        file.clear();
        file.seekg(static_cast<std::streamoff>(at));
        file.read(bytes.data(), static_cast<std::streamsize>(size));
        bytes.resize(static_cast<std::size_t>(file.gcount()));
        return bytes;
    };
    // A recorder that reserves room leaves one value in all of what it did not need.
    const auto is_padding = [&](std::uint64_t at, std::uint64_t rest) {
        constexpr std::uint64_t piece = 1 << 16;
        const std::string first = read(at, 1);
        for (std::uint64_t done = 0; done < rest; done += piece)
            if (read(at + done, std::min(piece, rest - done)).find_first_not_of(first) != std::string::npos)
                return false;
        return true;
    };
    std::string format, kept;
    std::optional<std::uint64_t> start;
    std::uint64_t size = 0, wanted = 0, long_size = 0;
    bool is_before_format = false, lacks_padding = false, is_wrong = !is_rf64 && stated + 8 > present;
    bool is_short = false;  // the stated size of the samples
    for (std::uint64_t at = 12; at + 8 <= present;) {
        const std::string chunk = read(at, 8);
        const std::string_view name = std::string_view(chunk).substr(0, 4);
        if (!is_chunk_name(name)) break;
        const std::uint64_t length = number_at(chunk, 4, 4), left = present - at - 8;
        if (name == "ds64" && length >= 16) long_size = number_at(read(at + 8, 16), 8, 8);
        else if (name == "fmt " && length >= 16 && length <= std::min<std::uint64_t>(left, 4096))
            format = read(at + 8, length);
        else if (name == "data") {
            start = at + 8;
            is_before_format = format.empty();
            wanted = is_rf64 && length >= 0x7fffffff ? long_size : length;
            size = std::min(wanted, left);
            // A recorder writes the size at the end of the recording.
            bool is_unfinished = wanted > left;
            if (wanted == 0 && left > 0) {
                const std::string next = read(at + 8, 8);
                is_unfinished =
                    !(next.size() == 8 && is_chunk_name(next.substr(0, 4)) && number_at(next, 4, 4) + 8 <= left);
            }
            // A recorder that was cut off, or a copied header: the samples go on behind their stated size.
            if (!is_unfinished && wanted > 0 && wanted < left) {
                const std::uint64_t end = at + 8 + wanted, rest = present - end;
                const std::string next = read(end + wanted % 2, 8);
                is_unfinished = !is_padding(end, rest) && !is_behind_samples(next, rest - std::min(rest, wanted % 2)) &&
                                !(wanted % 2 != 0 && is_behind_samples(read(end, 8), rest));
                is_short = is_unfinished;
            }
            if (is_unfinished) {
                size = left, is_wrong = true;
                break;
            }
            at += 8 + wanted + wanted % 2;
            if (!format.empty()) break;
            continue;
        } else if ((name == "LIST" || name == "bext") && length <= std::min(left, max_kept)) {
            put_chunk(kept, name, read(at + 8, length));
        }
        const std::uint64_t next = at + 8 + length;
        // Some programs leave out the byte behind a chunk of odd length.
        const bool is_unpadded = length % 2 != 0 && is_known_chunk(read(next, 4));
        lacks_padding = lacks_padding || is_unpadded;
        at = next + (is_unpadded ? 0 : length % 2);
    }
    if (!start || format.size() < 16 || size == 0) return std::nullopt;
    if (!is_wrong && !is_before_format && !lacks_padding) return std::nullopt;
    const std::uint64_t frame = std::max<std::uint64_t>(1, number_at(format, 12, 2));
    size -= size % frame;
    if (size == 0) return std::nullopt;

    WaveHeader made;
    made.start = *start;
    made.size = size;
    const bool is_long = size > 0xfffffff0u - kept.size() - format.size() - 64;
    std::string body = "WAVE";
    if (is_long) {
        std::string sizes;
        put(sizes, size + kept.size() + format.size() + 64, 8);
        put(sizes, size, 8);
        put(sizes, size / frame, 8);
        put(sizes, 0, 4);
        put_chunk(body, "ds64", sizes);
    }
    put_chunk(body, "fmt ", format);
    body += kept;
    body += "data";
    put(body, is_long ? 0xffffffffu : size, 4);
    made.bytes = is_long ? "RF64" : "RIFF";
    put(made.bytes, is_long ? 0xffffffffu : body.size() + size, 4);
    made.bytes += body;
    const bool is_unknown = wanted == 0 || wanted >= 0x7fffff00;
    made.note =
        is_short ? fmt::format(
                       "the header states {} bytes of samples, and {} follow that are no chunk; they were read as "
                       "samples",
                       wanted, present - *start - wanted)
        : is_before_format && !is_wrong ? std::string("the samples stand before their format in the file")
        : lacks_padding && !is_wrong    ? std::string("a chunk of odd length lacks its padding byte")
        : size >= wanted && !is_unknown
            ? fmt::format("the header states {} bytes and the file has {}; all samples are there", stated + 8, present)
        : is_unknown ? fmt::format(
                           "the recording was not finished: its header states no length; the {} bytes of "
                           "samples that the file has were read",
                           size)
                     : fmt::format("the sound is cut short: the {} of {} bytes of samples that the file has were read",
                                   size, wanted);
    return made;
}

}  // namespace tactus::sound
