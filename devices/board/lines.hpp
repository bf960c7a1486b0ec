// SPDX-License-Identifier: Apache-2.0
// Protocols of a board's serial line. One exchange per round: torques out, angles in.
#pragma once

#include "devices/board/board_frames.hpp"
#include "devices/gripper/frame.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::board {

/// The newest state received from a board.
struct Told {
    std::array<double, 2> angle{};  ///< rad
    std::uint32_t buttons = 0, serial = 0;
    std::uint64_t count = 0;  ///< answers so far
    std::uint64_t heard = 0;  ///< complete answers, including those rejected as implausible
};

class Protocol {
public:
    virtual ~Protocol() = default;
    /// Bytes to send after the line is opened.
    virtual std::vector<std::uint8_t> greeting() { return {}; }
    /// Builds the next request, with torques in N·m. `run` false: no torque.
    virtual std::span<const std::uint8_t> request(const std::array<double, 2>& torque, bool run) noexcept = 0;
    /// Processes received bytes. `silence_ns`: time since the previous bytes.
    virtual void take(std::span<const std::uint8_t> bytes, std::int64_t silence_ns) noexcept = 0;
    /// Call after the line is opened again.
    virtual void reset() noexcept = 0;
    /// Time for which the line must be silent before the request is repeated without an answer. 0: at any time.
    virtual std::int64_t patience_ns() const noexcept { return 0; }
    /// Minimum duration of a request and its answer on the line, s.
    virtual double exchange_s() const noexcept { return 0.0; }
    const Told& told() const noexcept { return told_; }

protected:
    Told told_;
};

/// The frames of Tactus, with a checksum.
class FrameProtocol final : public Protocol {
public:
    FrameProtocol(int motors, int baud) : motors_(motors), baud_(baud) {}
    std::span<const std::uint8_t> request(const std::array<double, 2>& torque, bool run) noexcept override;
    void take(std::span<const std::uint8_t> bytes, std::int64_t silence_ns) noexcept override;
    void reset() noexcept override;
    /// A little more than the duration of a request and its answer: torques that wait in the line would come too late.
    std::int64_t patience_ns() const noexcept override;
    double exchange_s() const noexcept override;

private:
    int motors_, baud_;
    std::uint16_t sequence_ = 0;
    gripper::FrameReader reader_;
    gripper::FrameBytes out_;
};

/// Haply's first board (2diy, firmware M3 1.5). It has no frame mark and no checksum: an answer begins after silence,
/// and counts only with the right length and range and within 10 degrees of the previous one. The last condition is
/// needed because the joined bytes of two truncated answers also decode as angles. A true jump is accepted with the
/// answer after it. A request sent during a truncated or foreign answer would delay that silence; see patience_ns.
class DiyProtocol final : public Protocol {
public:
    struct Settings {
        std::array<double, 2> offset_deg{180.0, 0.0};  ///< of the encoders
        double counts = 13'824.0;  ///< of an encoder, per revolution
    };
    explicit DiyProtocol(const Settings& settings) : settings_(settings) {}
    std::vector<std::uint8_t> greeting() override;
    std::span<const std::uint8_t> request(const std::array<double, 2>& torque, bool run) noexcept override;
    void take(std::span<const std::uint8_t> bytes, std::int64_t silence_ns) noexcept override;
    void reset() noexcept override;
    std::int64_t patience_ns() const noexcept override { return 4'000'000; }

private:
    static constexpr std::size_t request_size = 10, answer_size = 9;
    Settings settings_;
    std::array<std::uint8_t, request_size> out_{};
    std::array<std::uint8_t, answer_size> held_{};
    std::array<double, 2> before_deg_{};
    std::size_t size_ = 0;
    bool skips_ = false, has_before_ = false;
};

}  // namespace tactus::board
