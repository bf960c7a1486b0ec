// SPDX-License-Identifier: Apache-2.0
// The serial protocol between host and gripper controller. All numbers little-endian:
//
//     offset  bytes
//     0       2      A5 5A
//     2       1      version, 1
//     3       1      kind: 1 drive (host to controller), 2 sample (controller to host); 3, 4: devices/board/board_frames.hpp
//     4       2      sequence number of the sender, one more with each frame, wraps
//     6       2      n, length of the payload, at most 64
//     8       n      payload
//     8 + n   4      CRC-32 (IEEE 802.3: polynomial EDB88320 reflected, start and end inverted) over bytes 2 … 8 + n − 1
//
//     drive, n = 14:   0  flags: bit 0 run (else hold), bit 1 low-friction mode    1  zero
//                      2  int32 speed of finger, µm/s      6  int32 speed of thumb      10  int32 cord of the rig, µm
//     sample, n = 20:  0  flags: bits 0, 1: finger, thumb slip; 2, 3: finger, thumb drive saturated;
//                         4: holding, because no drive frame arrived for 50 ms or the last one requested hold
//                      1  number of fingers    2  uint16 sequence number of the active drive frame
//                      4  int32 encoder of finger, pulses    8  of thumb    12  int32 gauge of finger, counts    16  of thumb
//
// A controller sends samples at 150 Hz or faster and must hold its motors when no valid drive frame arrives for 50 ms.
// The checksum has 32 bits, because with 16 bits one of 65 536 damaged frames could move a finger.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus::gripper {

enum class FrameKind : std::uint8_t { drive = 1, sample = 2, torque = 3, joints = 4 };

inline constexpr std::size_t max_payload = 64, frame_overhead = 12;

struct Frame {
    FrameKind kind = FrameKind::drive;
    std::uint16_t sequence = 0;
    std::size_t size = 0;
    std::array<std::uint8_t, max_payload> payload{};
};

struct DriveFrame {
    bool run = false, free = false;
    std::array<std::int32_t, 2> speed_um_s{};
    std::int32_t cord_um = 0;
};

struct SampleFrame {
    std::array<bool, 2> slips{}, limited{};
    bool holds = false;
    std::uint8_t fingers = 1;
    std::uint16_t answers = 0;
    std::array<std::int32_t, 2> encoder{}, gauge{};
};

std::uint32_t crc32(std::span<const std::uint8_t> bytes) noexcept;

Frame pack(const DriveFrame& drive, std::uint16_t sequence) noexcept;
Frame pack(const SampleFrame& sample, std::uint16_t sequence) noexcept;
/// Returns false for another kind or length.
bool unpack(const Frame& frame, DriveFrame& out) noexcept;
bool unpack(const Frame& frame, SampleFrame& out) noexcept;

struct FrameBytes {
    std::array<std::uint8_t, max_payload + frame_overhead> bytes{};
    std::size_t size = 0;
};
FrameBytes encode(const Frame& frame) noexcept;

/// Finds frames in a byte stream with gaps, errors and foreign data. Does not allocate.
class FrameReader {
public:
    struct Counts {
        std::uint64_t good = 0, bad_checksum = 0, bad_header = 0, skipped_bytes = 0;
    };

    /// Adds a byte. Returns true if it completes a valid frame, which is then `frame()`.
    bool take(std::uint8_t byte) noexcept;
    const Frame& frame() const noexcept { return frame_; }
    const Counts& counts() const noexcept { return counts_; }

private:
    bool look() noexcept;
    void drop(std::size_t bytes) noexcept;

    std::array<std::uint8_t, max_payload + frame_overhead> held_{};
    std::size_t size_ = 0;
    Frame frame_;
    Counts counts_;
};

}  // namespace tactus::gripper
