// SPDX-License-Identifier: Apache-2.0
// A gripper's controller at the other end of a pseudo-terminal: a finger on the rig, simulated, and a line that can be
// slow, lossy, noisy or cut.
#pragma once

#include "devices/gripper/frame.hpp"
#include "dsp/core/random.hpp"
#include "dsp/simulate/gripper/finger.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tactus::test {

struct LineTrouble {
    std::atomic<int> delay_frames{0};     ///< samples that wait in the line
    std::atomic<int> drop_percent{0}, corrupt_percent{0};
    std::atomic<bool> silent{false};      ///< sends nothing
};

/// Runs in steps of 1 ms of its own time, as fast as the host asks for (it answers what it gets) or at `real` pace.
class StandInController {
public:
    StandInController() {
        master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
        ::grantpt(master_);
        ::unlockpt(master_);
        char name[128] = {};
        ::ptsname_r(master_, name, sizeof name);
        path = name;
        termios line{};
        ::tcgetattr(master_, &line);
        ::cfmakeraw(&line);
        ::tcsetattr(master_, TCSANOW, &line);
        simulate::WalkingMotor motor;
        finger_.motor = motor;
        finger_.delay = 0;
        thread_ = std::thread([this] { run(); });
    }
    ~StandInController() {
        ending_ = true;
        thread_.join();
        if (master_ >= 0) ::close(master_);
    }
    /// The cable is pulled: the host's line is gone for good. Returns when it is.
    void disconnect() {
        cut_ = true;
        while (!is_cut_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    std::string path;
    LineTrouble trouble;
    std::atomic<double> position{0.0}, told_speed{0.0};
    std::atomic<bool> holds{true};
    std::atomic<std::uint64_t> drives{0}, bad{0};

private:
    void run() {
        const Random random{17};
        std::uint64_t draw = 0;
        std::uint16_t sequence = 0, answers = 0;
        std::deque<std::vector<std::uint8_t>> line;
        gripper::FrameReader reader;
        gripper::DriveFrame drive;
        int since_drive = 1000;
        while (!ending_) {
            if (cut_ && master_ >= 0) {
                ::close(master_);
                master_ = -1;
                is_cut_ = true;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            if (master_ < 0) continue;
            std::uint8_t bytes[256];
            for (ssize_t n; (n = ::read(master_, bytes, sizeof bytes)) > 0;)
                for (ssize_t i = 0; i < n; ++i)
                    if (reader.take(bytes[i]) && gripper::unpack(reader.frame(), drive)) {
                        since_drive = 0;
                        answers = reader.frame().sequence;
                        ++drives;
                    }
            bad = reader.counts().bad_checksum + reader.counts().bad_header;
            ++since_drive;
            const bool still = !drive.run || since_drive > 50;
            finger_.advance(still ? 0.0 : drive.speed_um_s[0] * 1e-6, drive.cord_um * 1e-6, 1e-3, drive.free);
            position = finger_.position;
            told_speed = still ? 0.0 : drive.speed_um_s[0] * 1e-6;
            holds = still;
            gripper::SampleFrame sample;
            sample.slips[0] = finger_.slipped;
            sample.holds = still;
            sample.answers = answers;
            sample.encoder[0] = static_cast<std::int32_t>(std::lround(finger_.position / (4.5e-3 / 16000.0)));
            sample.gauge[0] = static_cast<std::int32_t>(std::lround(finger_.force * 410.0 + 100.0));
            const gripper::FrameBytes out = gripper::encode(gripper::pack(sample, ++sequence));
            std::vector<std::uint8_t> frame(out.bytes.begin(),
                                            out.bytes.begin() + static_cast<std::ptrdiff_t>(out.size));
            if (static_cast<int>(random.bits(draw++) % 100) < trouble.corrupt_percent) {
                const std::size_t at = random.bits(draw++) % frame.size();
                frame[at] ^= static_cast<std::uint8_t>(1u << random.bits(draw++) % 8);
            }
            if (static_cast<int>(random.bits(draw++) % 100) >= trouble.drop_percent) line.push_back(std::move(frame));
            while (static_cast<int>(line.size()) > trouble.delay_frames) {
                if (!trouble.silent) [[maybe_unused]]
                    const ssize_t sent = ::write(master_, line.front().data(), line.front().size());
                line.pop_front();
            }
        }
    }

    int master_ = -1;
    simulate::Finger finger_;
    std::atomic<bool> ending_{false}, cut_{false}, is_cut_{false};
    std::thread thread_;
};

}  // namespace tactus::test
