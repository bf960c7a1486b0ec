// SPDX-License-Identifier: Apache-2.0
// Changes of written DICOM files, to those that scanners and programs write against the standard or at its edges.
#pragma once

#include "tests/assets/volume/written_volume.hpp"

#include <zlib.h>

#include <cstddef>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace tactus {

inline std::string tag_bytes(unsigned group, unsigned number) {
    std::string out;
    for (const unsigned each : {group, number})
        out += static_cast<char>(each & 0xff), out += static_cast<char>(each >> 8);
    return out;
}

/// Value of an explicit element with a short length, replaced.
inline std::string with_value(std::string bytes, unsigned group, unsigned number,
                              const std::function<std::string(std::string)>& change) {
    const std::size_t at = bytes.find(tag_bytes(group, number), 132);
    if (at == std::string::npos) throw std::logic_error("the element is not there");
    const auto size = static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + 6]));
    std::string value = change(bytes.substr(at + 8, size));
    if (value.size() % 2 != 0) value += ' ';
    bytes.replace(at + 8, size, value);
    bytes[at + 6] = static_cast<char>(value.size());
    return bytes;
}

inline std::string before_samples(std::string bytes, const std::string& more) {
    return bytes.insert(bytes.find(tag_bytes(0x7fe0, 0x10), 132), more);
}

/// The data set packed by raw deflate, as transfer syntax 1.2.840.10008.1.2.1.99.
inline std::string deflated(std::string bytes) {
    const std::string plain = "1.2.840.10008.1.2.1";
    const std::size_t at = bytes.find(plain), meta = static_cast<unsigned char>(bytes[140]);
    if (at == std::string::npos) throw std::logic_error("the element is not there");
    const std::string set = bytes.substr(144 + meta);
    std::string packed(compressBound(set.size()) + 64, '\0');
    z_stream stream{};
    if (deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(set.data()));
    stream.avail_in = static_cast<uInt>(set.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out + stream.total_out % 2);
    deflateEnd(&stream);
    bytes.resize(144 + meta);
    bytes.replace(at, plain.size() + 1, plain + ".99");
    bytes[at - 2] = static_cast<char>(plain.size() + 3);
    bytes[140] = static_cast<char>(meta + 2);
    return bytes + packed;
}

/// A private sequence of unknown kind and undefined length (CP-246).
inline std::string with_unknown_sequence(std::string bytes) {
    const std::string un = tag_bytes(0x29, 0x1010) + std::string("UN\0\0\xff\xff\xff\xff", 8) +
                           tag_bytes(0xfffe, 0xe000) + std::string("\xff\xff\xff\xff", 4) + tag_bytes(0x29, 0x1011) +
                           std::string("\4\0\0\0ABCD", 8) + tag_bytes(0xfffe, 0xe00d) + std::string(4, '\0') +
                           tag_bytes(0xfffe, 0xe0dd) + std::string(4, '\0');
    return before_samples(std::move(bytes), un);
}

/// The pixel spacing (0028,0030) as unlimited text.
inline std::string with_spacing_as_text(std::string bytes) {
    const std::size_t at = bytes.find(tag_bytes(0x28, 0x30), 132);
    const std::string size(1, bytes[at + 6]);
    return bytes.replace(at + 4, 4, std::string("UT\0\0", 4) + size + std::string(3, '\0'));
}

/// The samples above 0 as a segmentation of one bit per sample, without gaps between frames, which go from the top slice down.
inline std::string one_bit_segmentation(const WrittenVolume& v) {
    const auto number = [](int value) {
        return [value](const std::string&) { return std::string{static_cast<char>(value), '\0'}; };
    };
    std::string bytes = enhanced_dicom_bytes(v);
    bytes = with_value(bytes, 0x8, 0x60, [](const std::string&) { return std::string("SEG "); });
    for (const auto& [element, value] : {std::pair{0x100u, 1}, {0x101u, 1}, {0x102u, 0}, {0x103u, 0}})
        bytes = with_value(bytes, 0x28, element, number(value));
    bytes = with_value(bytes, 0x28, 0x1052, [](std::string value) {
        return value.replace(0, value.size(), "0" + std::string(value.size() - 1, ' '));
    });
    const std::size_t each = static_cast<std::size_t>(v.size[0]) * static_cast<std::size_t>(v.size[1]);
    const std::size_t frames = static_cast<std::size_t>(v.size[2]);
    std::string packed((each * frames + 15) / 16 * 2, '\0');
    for (std::size_t n = 0; n < each * frames; ++n)
        if (v.hu[(frames - 1 - n / each) * each + n % each] > 0)
            packed[n / 8] = static_cast<char>(packed[n / 8] | 1 << (n % 8));
    const auto byte = [&](std::size_t shift) { return static_cast<char>(packed.size() >> shift & 0xff); };
    return bytes.substr(0, bytes.find(tag_bytes(0x7fe0, 0x10), 132) + 8) +
           std::string{byte(0), byte(8), byte(16), '\0'} + packed;
}

}  // namespace tactus
