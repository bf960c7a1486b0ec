// SPDX-License-Identifier: Apache-2.0
#include "devices/gripper/frame.hpp"

#include <algorithm>
#include <cstring>

namespace tactus::gripper {

namespace {

constexpr std::uint8_t first_sync = 0xA5, second_sync = 0x5A, version = 1;
constexpr std::size_t header = 8, checksum = 4;

constexpr std::array<std::uint32_t, 256> crc_table = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t n = 0; n < 256; ++n) {
        std::uint32_t c = n;
        for (int bit = 0; bit < 8; ++bit) c = c & 1u ? 0xEDB88320u ^ (c >> 1) : c >> 1;
        table[n] = c;
    }
    return table;
}();

template <class T>
void put(std::uint8_t* at, T value) noexcept {
    for (std::size_t i = 0; i < sizeof(T); ++i)
        at[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
}

std::uint32_t get32(const std::uint8_t* at) noexcept {
    return static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8 |
           static_cast<std::uint32_t>(at[2]) << 16 | static_cast<std::uint32_t>(at[3]) << 24;
}
std::uint16_t get16(const std::uint8_t* at) noexcept { return static_cast<std::uint16_t>(at[0] | at[1] << 8); }
std::int32_t get_signed(const std::uint8_t* at) noexcept { return static_cast<std::int32_t>(get32(at)); }

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes) noexcept {
    std::uint32_t c = 0xFFFFFFFFu;
    for (const std::uint8_t byte : bytes) c = crc_table[(c ^ byte) & 0xFFu] ^ (c >> 8);
    return ~c;
}

Frame pack(const DriveFrame& drive, std::uint16_t sequence) noexcept {
    Frame frame{FrameKind::drive, sequence, 14, {}};
    std::uint8_t* p = frame.payload.data();
    p[0] = static_cast<std::uint8_t>((drive.run ? 1 : 0) | (drive.free ? 2 : 0));
    put(p + 2, drive.speed_um_s[0]);
    put(p + 6, drive.speed_um_s[1]);
    put(p + 10, drive.cord_um);
    return frame;
}

Frame pack(const SampleFrame& sample, std::uint16_t sequence) noexcept {
    Frame frame{FrameKind::sample, sequence, 20, {}};
    std::uint8_t* p = frame.payload.data();
    p[0] =
        static_cast<std::uint8_t>((sample.slips[0] ? 1 : 0) | (sample.slips[1] ? 2 : 0) | (sample.limited[0] ? 4 : 0) |
                                  (sample.limited[1] ? 8 : 0) | (sample.holds ? 16 : 0));
    p[1] = sample.fingers;
    put(p + 2, sample.answers);
    put(p + 4, sample.encoder[0]);
    put(p + 8, sample.encoder[1]);
    put(p + 12, sample.gauge[0]);
    put(p + 16, sample.gauge[1]);
    return frame;
}

bool unpack(const Frame& frame, DriveFrame& out) noexcept {
    if (frame.kind != FrameKind::drive || frame.size != 14) return false;
    const std::uint8_t* p = frame.payload.data();
    out = {(p[0] & 1) != 0, (p[0] & 2) != 0, {get_signed(p + 2), get_signed(p + 6)}, get_signed(p + 10)};
    return true;
}

bool unpack(const Frame& frame, SampleFrame& out) noexcept {
    if (frame.kind != FrameKind::sample || frame.size != 20) return false;
    const std::uint8_t* p = frame.payload.data();
    if (p[1] < 1 || p[1] > 2) return false;
    out.slips = {(p[0] & 1) != 0, (p[0] & 2) != 0};
    out.limited = {(p[0] & 4) != 0, (p[0] & 8) != 0};
    out.holds = (p[0] & 16) != 0;
    out.fingers = p[1];
    out.answers = get16(p + 2);
    out.encoder = {get_signed(p + 4), get_signed(p + 8)};
    out.gauge = {get_signed(p + 12), get_signed(p + 16)};
    return true;
}

FrameBytes encode(const Frame& frame) noexcept {
    FrameBytes out;
    std::uint8_t* p = out.bytes.data();
    const std::size_t size = std::min(frame.size, max_payload);
    p[0] = first_sync;
    p[1] = second_sync;
    p[2] = version;
    p[3] = static_cast<std::uint8_t>(frame.kind);
    put(p + 4, frame.sequence);
    put(p + 6, static_cast<std::uint16_t>(size));
    std::memcpy(p + header, frame.payload.data(), size);
    put(p + header + size, crc32({p + 2, header - 2 + size}));
    out.size = header + size + checksum;
    return out;
}

void FrameReader::drop(std::size_t bytes) noexcept {
    std::memmove(held_.data(), held_.data() + bytes, size_ - bytes);
    size_ -= bytes;
}

bool FrameReader::take(std::uint8_t byte) noexcept {
    held_[size_++] = byte;
    return look();
}

/// Parses the buffer from its start. Drops one byte at a time when there is no valid frame, so that a valid frame
/// inside is found.
bool FrameReader::look() noexcept {
    while (size_ > 0) {
        const std::uint8_t* p = held_.data();
        const bool sync = p[0] == first_sync && (size_ < 2 || p[1] == second_sync);
        const bool head = sync && (size_ < 3 || p[2] == version) && (size_ < 4 || (p[3] >= 1 && p[3] <= 4)) &&
                          (size_ < header || get16(p + 6) <= max_payload);
        if (!head) {
            if (sync && size_ >= 3) ++counts_.bad_header;
            ++counts_.skipped_bytes;
            drop(1);
            continue;
        }
        if (size_ < header) return false;
        const std::size_t payload = get16(p + 6), whole = header + payload + checksum;
        if (size_ < whole) return false;
        if (crc32({p + 2, header - 2 + payload}) != get32(p + header + payload)) {
            ++counts_.bad_checksum;
            ++counts_.skipped_bytes;
            drop(1);
            continue;
        }
        frame_ = {static_cast<FrameKind>(p[3]), get16(p + 4), payload, {}};
        std::memcpy(frame_.payload.data(), p + header, payload);
        ++counts_.good;
        drop(whole);
        return true;
    }
    return false;
}

}  // namespace tactus::gripper
