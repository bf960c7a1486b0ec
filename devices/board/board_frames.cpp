// SPDX-License-Identifier: Apache-2.0
#include "devices/board/board_frames.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::board {

namespace {

using gripper::Frame;
using gripper::FrameKind;

constexpr std::size_t torque_size = 10, joints_size = 20;

void put(std::uint8_t* at, std::uint32_t value, int bytes) noexcept {
    for (int i = 0; i < bytes; ++i) at[i] = static_cast<std::uint8_t>(value >> (8 * i));
}
std::uint32_t get(const std::uint8_t* at, int bytes) noexcept {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) value |= static_cast<std::uint32_t>(at[i]) << (8 * i);
    return value;
}

/// In millionths; what is no number is zero.
std::uint32_t micro(double value) noexcept {
    if (!std::isfinite(value)) return 0;
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(std::clamp(value * 1e6, -2e9, 2e9))));
}
double from_micro(const std::uint8_t* at) noexcept { return 1e-6 * static_cast<std::int32_t>(get(at, 4)); }

}  // namespace

Frame pack(const TorqueFrame& torque, std::uint16_t sequence) noexcept {
    Frame frame{FrameKind::torque, sequence, torque_size, {}};
    std::uint8_t* const p = frame.payload.data();
    p[0] = torque.run ? 1 : 0;
    p[1] = static_cast<std::uint8_t>(torque.motors);
    put(p + 2, micro(torque.torque[0]), 4);
    put(p + 6, micro(torque.torque[1]), 4);
    return frame;
}

Frame pack(const JointsFrame& joints, std::uint16_t sequence) noexcept {
    Frame frame{FrameKind::joints, sequence, joints_size, {}};
    std::uint8_t* const p = frame.payload.data();
    p[0] = joints.holds ? 1 : 0;
    p[1] = static_cast<std::uint8_t>(joints.motors);
    put(p + 2, joints.answers, 2);
    put(p + 4, micro(joints.angle[0]), 4);
    put(p + 8, micro(joints.angle[1]), 4);
    put(p + 12, joints.buttons, 2);
    put(p + 16, joints.serial, 4);
    return frame;
}

bool unpack(const Frame& frame, TorqueFrame& out) noexcept {
    const std::uint8_t* const p = frame.payload.data();
    if (frame.kind != FrameKind::torque || frame.size != torque_size || p[1] < 1 || p[1] > 2) return false;
    out = {(p[0] & 1) != 0, p[1], {from_micro(p + 2), from_micro(p + 6)}};
    return true;
}

bool unpack(const Frame& frame, JointsFrame& out) noexcept {
    const std::uint8_t* const p = frame.payload.data();
    if (frame.kind != FrameKind::joints || frame.size != joints_size || p[1] < 1 || p[1] > 2) return false;
    out.holds = (p[0] & 1) != 0;
    out.motors = p[1];
    out.answers = static_cast<std::uint16_t>(get(p + 2, 2));
    out.angle = {from_micro(p + 4), from_micro(p + 8)};
    out.buttons = get(p + 12, 2);
    out.serial = get(p + 16, 4);
    return true;
}

}  // namespace tactus::board
