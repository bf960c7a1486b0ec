// SPDX-License-Identifier: Apache-2.0
// What a board speaks on its serial line. One exchange a round: torques out, angles in.
#pragma once

#include "devices/board/board_frames.hpp"
#include "devices/gripper/frame.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::board {

/// The newest that a board told.
struct Told {
    std::array<double, 2> angle{};  ///< rad
    std::uint32_t buttons = 0, serial = 0;
    std::uint64_t count = 0;  ///< answers so far
    std::uint64_t heard = 0;  ///< whole ones, also those that were not believed
};

class Protocol {
public:
    virtual ~Protocol() = default;
    /// What a line is told when it was opened.
    virtual std::vector<std::uint8_t> greeting() { return {}; }
    /// The next request, with torques in N·m. `run`: false: no torque.
    virtual std::span<const std::uint8_t> request(const std::array<double, 2>& torque, bool run) noexcept = 0;
    /// Takes received bytes. `silence_ns`: time since the bytes before.
    virtual void take(std::span<const std::uint8_t> bytes, std::int64_t silence_ns) noexcept = 0;
    /// The line was opened anew.
    virtual void reset() noexcept = 0;
    /// How long the line must be silent before it is asked again without an answer. 0: it may be asked at any time.
    virtual std::int64_t patience_ns() const noexcept { return 0; }
    /// s that a request and its answer take on the line, at least.
    virtual double exchange_s() const noexcept { return 0.0; }
    const Told& told() const noexcept { return told_; }

protected:
    Told told_;
};

/// Tactus' own frames with a checksum.
class FrameProtocol final : public Protocol {
public:
    FrameProtocol(int motors, int baud) : motors_(motors), baud_(baud) {}
    std::span<const std::uint8_t> request(const std::array<double, 2>& torque, bool run) noexcept override;
    void take(std::span<const std::uint8_t> bytes, std::int64_t silence_ns) noexcept override;
    void reset() noexcept override;
    /// A little more than a request and its answer take on the line: torques that wait there come too late.
    std::int64_t patience_ns() const noexcept override;
    double exchange_s() const noexcept override;

private:
    int motors_, baud_;
    std::uint16_t sequence_ = 0;
    gripper::FrameReader reader_;
    gripper::FrameBytes out_;
};

/// Haply's first board (2diy, firmware M3 1.5): no frame mark and no checksum, so that only silence tells where an
/// answer begins, and only an answer of the right length and range counts, within 10 degrees of the one before: bytes of two
/// answers, joined where one was cut, are angles, too. A true jump counts with the answer after it. Who asks on while an answer is cut or foreign
/// never leaves the line silent.
class DiyProtocol final : public Protocol {
public:
    struct Settings {
        std::array<double, 2> offset_deg{180.0, 0.0};  ///< of the encoders
        double counts = 13'824.0;  ///< of an encoder, per turn
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
