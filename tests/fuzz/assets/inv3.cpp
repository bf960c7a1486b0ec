// SPDX-License-Identifier: Apache-2.0
// Any bytes called .inv3 are a volume with as many samples as it says, or a tactus::Error. Bytes that are not packed yet
// are, so that mutations reach the archive and the list inside.
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/fuzz/memory_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <string>

namespace {

// A gzip file whose one block of deflate is merely stored (RFC 1952, RFC 1951 section 3.2.4).
std::string packed(const std::uint8_t* data, std::size_t size) {
    std::string out("\x1f\x8b\x08\0\0\0\0\0\0\x03", 10);
    const auto put = [&out](std::uint32_t value, int bytes) {
        for (int n = 0; n < bytes; ++n) out += static_cast<char>(value >> (8 * n) & 0xffu);
    };
    std::size_t at = 0;
    do {
        const std::size_t part = std::min<std::size_t>(size - at, 65535);
        put(at + part == size ? 1 : 0, 1);
        put(static_cast<std::uint32_t>(part), 2);
        put(~static_cast<std::uint32_t>(part), 2);
        out.append(reinterpret_cast<const char*>(data) + at, part);
        at += part;
    } while (at < size);
    put(static_cast<std::uint32_t>(crc32(0, data, static_cast<unsigned>(size))), 4);
    put(static_cast<std::uint32_t>(size), 4);
    return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const bool is_packed = size >= 2 && data[0] == 0x1f && data[1] == 0x8b;
    const std::string bytes = is_packed ? std::string(reinterpret_cast<const char*>(data), size) : packed(data, size);
    const tactus::MemoryFile file(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), "v.inv3");
    try {
        const tactus::volume::ScanVolume volume = tactus::volume::read_volume(file.path());
        if (volume.values.size() != volume.count()) std::abort();
    } catch (const tactus::Error&) {
        // Refusing is right for most bytes.
    }
    return 0;
}
