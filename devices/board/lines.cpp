// SPDX-License-Identifier: Apache-2.0
#include "devices/board/lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace tactus::board {

std::span<const std::uint8_t> FrameProtocol::request(const std::array<double, 2>& torque, bool run) noexcept {
    out_ = gripper::encode(pack(TorqueFrame{run, motors_, torque}, ++sequence_));
    return {out_.bytes.data(), out_.size};
}

void FrameProtocol::take(std::span<const std::uint8_t> bytes, std::int64_t) noexcept {
    for (const std::uint8_t byte : bytes) {
        JointsFrame joints;
        if (!reader_.take(byte) || !unpack(reader_.frame(), joints) || joints.motors != motors_) continue;
        told_.angle = joints.angle;
        told_.buttons = joints.buttons;
        told_.serial = joints.serial;
        ++told_.heard;
        ++told_.count;
    }
}

double FrameProtocol::exchange_s() const noexcept {
    return 10.0 * (22 + 32) / baud_;  // both frames, each byte with a start and a stop bit
}

std::int64_t FrameProtocol::patience_ns() const noexcept {
    return std::max<std::int64_t>(4'000'000, std::llround(1.25e9 * exchange_s()));
}

void FrameProtocol::reset() noexcept {
    reader_ = {};
    sequence_ = 0;
}

namespace {

constexpr std::uint8_t board_id = 5;
constexpr std::int64_t gap_ns = 3'000'000;
constexpr float max_degrees = 720.0f;
constexpr double max_jump_deg = 10.0;

void append(std::vector<std::uint8_t>& bytes, double number) {
    const auto value = static_cast<float>(number);
    std::uint8_t four[4];
    std::memcpy(four, &value, sizeof four);  // little-endian, as this machine
    bytes.insert(bytes.end(), four, four + 4);
}

}  // namespace

/// A reset, then the setup: two motors, two encoders, no sensors, no PWM outputs.
std::vector<std::uint8_t> DiyProtocol::greeting() {
    std::vector<std::uint8_t> bytes{0, board_id, 1, board_id};
    bytes.insert(bytes.end(), {0x03, 1, 2});   // motors: mask, and the port of each
    bytes.insert(bytes.end(), {0x03, 1, 2});   // encoders, likewise
    bytes.insert(bytes.end(), {0, 0});         // sensors, PWM outputs
    for (const double offset : settings_.offset_deg) {
        append(bytes, offset);
        append(bytes, settings_.counts);
    }
    return bytes;
}

std::span<const std::uint8_t> DiyProtocol::request(const std::array<double, 2>& torque, bool run) noexcept {
    out_[0] = 2;
    out_[1] = board_id;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto value = run && std::isfinite(torque[i]) ? static_cast<float>(torque[i]) : 0.0f;
        std::memcpy(out_.data() + 2 + 4 * i, &value, 4);
    }
    return out_;
}

void DiyProtocol::take(std::span<const std::uint8_t> bytes, std::int64_t silence_ns) noexcept {
    if (silence_ns > gap_ns) {
        size_ = 0;
        skips_ = false;
    }
    for (const std::uint8_t byte : bytes) {
        // After a byte that cannot be, all is foreign until the line is silent.
        if (skips_ || (size_ == 0 && byte != board_id)) {
            skips_ = true;
            continue;
        }
        held_[size_++] = byte;
        if (size_ < answer_size) continue;
        size_ = 0;
        float degrees[2];
        std::memcpy(degrees, held_.data() + 1, sizeof degrees);
        if (!(std::abs(degrees[0]) <= max_degrees) || !(std::abs(degrees[1]) <= max_degrees)) {
            skips_ = true;
            continue;
        }
        ++told_.heard;
        bool is_near = has_before_;
        for (std::size_t i = 0; i < 2; ++i) {
            is_near = is_near && std::abs(degrees[i] - before_deg_[i]) <= max_jump_deg;
            before_deg_[i] = degrees[i];
        }
        has_before_ = true;
        if (!is_near) continue;
        for (std::size_t i = 0; i < 2; ++i) told_.angle[i] = before_deg_[i] * std::numbers::pi / 180.0;
        ++told_.count;
    }
}

void DiyProtocol::reset() noexcept {
    size_ = 0;
    skips_ = has_before_ = false;
}

}  // namespace tactus::board
