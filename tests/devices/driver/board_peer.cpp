// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/driver/board_peer.hpp"

#include "devices/board/board_frames.hpp"
#include "devices/board/serial_board.hpp"
#include "dsp/core/random.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <deque>
#include <filesystem>
#include <limits>
#include <mutex>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

namespace tactus::test {

namespace {

// The linkage: proximal 50 mm, distal 70 mm, motors 20 mm apart.
constexpr double near = 0.05, far = 0.07, half = 0.01;

/// Angle of one motor for a handle at (x, y) before the motors: elbow outwards. `side`: −1 left, 1 right.
double angle_for(double x, double y, int side) {
    const double dx = x - side * half, dy = y, reach = std::hypot(dx, dy);
    const double between = std::acos((near * near + reach * reach - far * far) / (2.0 * near * reach));
    return std::atan2(dy, dx) - side * between;
}

/// A board at a line of its own. It is turned by half a turn: its motors are on the far side of the handle.
class BoardPeer : public Peer {
public:
    explicit BoardPeer(bool speaks_frames) : speaks_frames_(speaks_frames) {
        turns = false;
        moves_along = 2;
        buttons = speaks_frames ? 2 : 0;
        // µrad, or degrees as float32.
        exact = speaks_frames ? 5e-7 : 2e-7;
        exact_force = speaks_frames ? 1e-4 : 1e-5;
        link_ = std::filesystem::temp_directory_path() /
                ("tactus_board_" + std::to_string(::getpid()) + "_" + std::to_string(next_++));
        plug();
        thread_ = std::thread([this] { run(); });
    }
    ~BoardPeer() override {
        ends_ = true;
        thread_.join();
        pull();
    }

    std::unique_ptr<driver::Backend> backend() override {
        std::vector<OptionText> given{{"port", link_.string(), {}},
                                      {"max_force", "1.5 N", {}},
                                      {"max_torque", "0.5 N m", {}},
                                      {"motors", "far", {}}};
        if (speaks_frames_) given.push_back({"mechanism", "pantograph", {}});
        Options options = options_of(given);
        return speaks_frames_ ? board::make_serial_board(options) : board::make_haply_2diy(options);
    }
    std::string line() const { return link_.string(); }
    LineFaults faults;
    void place(const Vec3& position, const Quat&) override {
        const std::lock_guard lock(mutex_);
        x_ = -position.x;
        y_ = -position.y;
    }
    void press(std::uint32_t mask) override { mask_ = mask; }
    /// From the torques, by virtual work: F = J⁻ᵀ τ with a Jacobian from small steps of the inverse kinematics.
    Wrench given() override {
        const std::lock_guard lock(mutex_);
        constexpr double step = 1e-7;
        double d[2][2];  // dθ_i / d(x, y)
        for (int i = 0; i < 2; ++i) {
            const int side = i == 0 ? -1 : 1;
            d[i][0] = (angle_for(x_ + step, y_, side) - angle_for(x_ - step, y_, side)) / (2.0 * step);
            d[i][1] = (angle_for(x_, y_ + step, side) - angle_for(x_, y_ - step, side)) / (2.0 * step);
        }
        return {{-(d[0][0] * torque_[0] + d[1][0] * torque_[1]), -(d[0][1] * torque_[0] + d[1][1] * torque_[1]), 0.0},
                {}};
    }
    void hang(bool on) override { is_silent_ = on; }
    void unplug(bool on) override {
        must_be_away_ = on;
        while (is_away_ != on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    void send_nan(bool on) override { is_nan_ = on; }
    void burst() override { must_burst_ = true; }

private:
    void plug() {
        master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
        ::grantpt(master_);
        ::unlockpt(master_);
        char name[128] = {};
        ::ptsname_r(master_, name, sizeof name);
        termios line{};
        ::tcgetattr(master_, &line);
        ::cfmakeraw(&line);
        ::tcsetattr(master_, TCSANOW, &line);
        std::filesystem::create_symlink(name, link_);
    }
    void pull() {
        if (master_ >= 0) ::close(master_);
        master_ = -1;
        std::filesystem::remove(link_);
        const std::lock_guard lock(mutex_);
        torque_ = {};
    }
    void send(const std::vector<std::uint8_t>& bytes) {
        [[maybe_unused]] const ssize_t sent = ::write(master_, bytes.data(), bytes.size());
    }
    bool happens(int percent) { return static_cast<int>(random_.bits(draw_++) % 100) < percent; }
    /// Foreign bytes; an answer of the board without frames begins with 5, and nothing tells such a byte from one.
    std::vector<std::uint8_t> noise(int count) {
        std::vector<std::uint8_t> bytes;
        for (int i = 0; i < count; ++i) {
            const auto byte = static_cast<std::uint8_t>(random_.bits(draw_++));
            bytes.push_back(byte == 5 ? 6 : byte);
        }
        return bytes;
    }
    void tell(const std::uint8_t* bytes, std::size_t size) {
        for (int i = 0; i < (must_burst_.exchange(false) ? 20 : 1); ++i) waiting_.emplace_back(bytes, bytes + size);
        while (static_cast<int>(waiting_.size()) > faults.late_answers) {
            std::vector<std::uint8_t> answer = std::move(waiting_.front());
            waiting_.pop_front();
            if (happens(faults.noise_percent)) send(noise(1 + static_cast<int>(random_.bits(draw_++) % 8)));
            if (happens(faults.cut_percent)) answer.resize(1 + random_.bits(draw_++) % (answer.size() - 1));
            if (!happens(faults.drop_percent)) send(answer);
        }
    }
    std::array<double, 2> angles() const { return {angle_for(x_, y_, -1), angle_for(x_, y_, 1)}; }
    void take_frame(std::uint8_t byte) {
        board::TorqueFrame torque;
        if (!reader_.take(byte) || !board::unpack(reader_.frame(), torque)) return;
        board::JointsFrame joints;
        {
            const std::lock_guard lock(mutex_);
            torque_ = torque.run ? torque.torque : std::array<double, 2>{};
            joints.angle = angles();
        }
        joints.motors = torque.motors;
        joints.buttons = mask_;
        joints.serial = 0xBEEF;
        gripper::FrameBytes out = gripper::encode(board::pack(joints, ++sequence_));
        if (is_nan_) out.bytes[12] ^= 0x10;  // a frame has no way to say that a number is none: it is damaged
        tell(out.bytes.data(), out.size);
    }
    void take_diy(std::uint8_t byte) {
        held_ += static_cast<char>(byte);
        if (held_[0] == 0 && held_.size() == 2) return held_.clear();
        if (held_[0] == 1 && held_.size() == 2 + 6 + 2 + 16) return held_.clear();
        if (held_[0] != 2 || held_.size() < 10) return;
        float wanted[2], told[2];
        std::memcpy(wanted, held_.data() + 2, sizeof wanted);
        held_.clear();
        {
            const std::lock_guard lock(mutex_);
            torque_ = {wanted[0], wanted[1]};
            const auto at = angles();
            for (int i = 0; i < 2; ++i)
                told[i] = is_nan_ ? std::numeric_limits<float>::quiet_NaN()
                                  : static_cast<float>(at[static_cast<std::size_t>(i)] * 180.0 / std::numbers::pi);
        }
        std::uint8_t answer[9] = {5};
        std::memcpy(answer + 1, told, sizeof told);
        tell(answer, sizeof answer);
    }
    /// Bytes that came over the line since it was asked for the last time.
    std::size_t may_hear(std::size_t most) {
        const auto now = std::chrono::steady_clock::now();
        const double came = std::chrono::duration<double>(now - asked_).count() * faults.bytes_per_s + part_;
        asked_ = now;
        if (faults.bytes_per_s == 0) return most;
        part_ = came - std::floor(came);
        return std::min(most, static_cast<std::size_t>(came));
    }
    void run() {
        auto heard = std::chrono::steady_clock::now();
        while (!ends_) {
            if (must_be_away_ != is_away_) {
                if (must_be_away_) pull();
                else plug();
                is_away_ = must_be_away_.load();
            }
            std::this_thread::sleep_for(std::chrono::microseconds(300));
            if (master_ < 0) continue;
            if (const int count = faults.burst.exchange(0); count > 0) send(noise(count));
            std::uint8_t bytes[256];
            const ssize_t count = is_silent_ ? 0 : ::read(master_, bytes, may_hear(sizeof bytes));
            if (count > 0) heard = std::chrono::steady_clock::now();
            for (ssize_t i = 0; i < count; ++i) speaks_frames_ ? take_frame(bytes[i]) : take_diy(bytes[i]);
            if (std::chrono::steady_clock::now() - heard > std::chrono::milliseconds(20)) {
                held_.clear();
                const std::lock_guard lock(mutex_);
                if (speaks_frames_) torque_ = {};  // Haply's board holds what it was told last
            }
        }
    }

    bool speaks_frames_;
    static inline int next_ = 0;
    std::filesystem::path link_;
    int master_ = -1;
    std::mutex mutex_;
    double x_ = 0.0, y_ = 0.1;
    std::array<double, 2> torque_{};
    std::atomic<std::uint32_t> mask_{0};
    std::atomic<bool> is_silent_{false}, is_nan_{false}, must_burst_{false}, must_be_away_{false}, is_away_{false},
        ends_{false};
    gripper::FrameReader reader_;
    std::uint16_t sequence_ = 0;
    std::string held_;
    std::deque<std::vector<std::uint8_t>> waiting_;
    const Random random_{23};
    std::uint64_t draw_ = 0;
    std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
    double part_ = 0.0;
    std::thread thread_;
};

}  // namespace

std::unique_ptr<Peer> make_frame_board_peer() { return std::make_unique<BoardPeer>(true); }
std::unique_ptr<Peer> make_diy_peer() { return std::make_unique<BoardPeer>(false); }
std::string line_of(Peer& board) { return dynamic_cast<BoardPeer&>(board).line(); }
LineFaults& faults_of(Peer& board) { return dynamic_cast<BoardPeer&>(board).faults; }

}  // namespace tactus::test
