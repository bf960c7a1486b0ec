// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/gamepad.hpp"

#include "devices/evdev/force_effect.hpp"
#include "devices/haptic/operated.hpp"
#include "devices/haptic/pulled_hand.hpp"
#include "devices/hosted/seqlock.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <thread>
#include <utility>

namespace tactus::haptic {

namespace {

namespace fs = std::filesystem;

constexpr double dead_zone = 0.1;
constexpr double longest_spring_m = 0.03;  // between the hand and where the sticks want it, under force
constexpr int poll_ms = 50, rumble_ms = 10;

/// Axes in the order of PadState.
constexpr std::array<std::uint16_t, 8> axis_codes{ABS_X, ABS_Y, ABS_RX, ABS_RY, ABS_Z, ABS_RZ, ABS_HAT0X, ABS_HAT0Y};

/// A, B, X, Y: trigger, second, third and fourth. Bit 1 of DeviceSample::buttons marks gaps of recordings.
constexpr std::pair<std::uint16_t, std::int64_t> button_codes[] = {
    {BTN_SOUTH, 1}, {BTN_EAST, 4}, {BTN_WEST, 8}, {BTN_NORTH, 16}};
constexpr std::pair<std::uint16_t, std::int64_t> roll_codes[] = {{BTN_TL, 1}, {BTN_TR, 2}};

bool is_trigger(std::size_t axis) { return axis == 4 || axis == 5; }

double beyond_dead_zone(double x) noexcept {
    if (!(std::abs(x) > dead_zone)) return 0.0;
    return std::copysign((std::min(std::abs(x), 1.0) - dead_zone) / (1.0 - dead_zone), x);
}

/// An open event device. Reads, and lets the motors rumble, on its own thread until it is destroyed or the gamepad is
/// lost.
class PadReader {
public:
    /// `felt`: the force that rumbles fully at `full_N`; 0: none does.
    PadReader(evdev::EventSystem& system, const std::string& path, const SharedWrench& felt, double full_N)
        : system_(system),
          felt_(felt),
          full_N_(full_N),
          file_(system.open(path, O_RDONLY | O_NONBLOCK)),
          effect_(system) {
        if (file_ < 0) throw Error(fmt::format("cannot open {}: {}", path, std::strerror(errno)));
        for (std::size_t i = 0; i < axis_codes.size(); ++i) {
            input_absinfo info{};
            const bool is_told = ask_axis(system_, file_, axis_codes[i], info) && info.maximum > info.minimum;
            // As most gamepads have it, and what a recording of one holds.
            least_[i] = is_told ? info.minimum : is_trigger(i) ? 0 : i < 6 ? -32768 : -1;
            most_[i] = is_told ? info.maximum : is_trigger(i) ? 255 : i < 6 ? 32767 : 1;
        }
        if (full_N_ > 0.0 && evdev::Bits::of_kind(system_, file_, EV_FF)[FF_RUMBLE]) begin_rumble(path);
        ask();
        state.write(state_);
        thread_ = std::thread([this] { read_all(); });
    }
    ~PadReader() {
        is_over_.store(true, std::memory_order_relaxed);
        thread_.join();
        effect_.end();
        if (rumble_file_ >= 0) system_.close(rumble_file_);
        system_.close(file_);
    }
    PadReader(const PadReader&) = delete;
    PadReader& operator=(const PadReader&) = delete;

    hosted::Seqlock<PadState> state;

private:
    double value_of(std::size_t axis, int raw) const {
        const double share = (static_cast<double>(raw) - least_[axis]) / (most_[axis] - least_[axis]);
        return std::clamp(is_trigger(axis) ? share : 2.0 * share - 1.0, -1.0, 1.0);
    }

    /// By a file of its own: who may only read the gamepad still has its sticks.
    void begin_rumble(const std::string& path) {
        rumble_file_ = system_.open(path, O_RDWR | O_NONBLOCK);
        if (rumble_file_ < 0) return;
        input_event gain{};
        gain.type = EV_FF;
        gain.code = FF_GAIN;
        gain.value = 0xFFFF;
        system_.write(rumble_file_, gain);
        if (!effect_.begin(rumble_file_, FF_RUMBLE)) system_.close(std::exchange(rumble_file_, -1));
    }

    /// A line that is slow gets no more than it can take.
    void rumble() noexcept {
        const std::int64_t now = steady_ns();
        if (rumble_file_ < 0 || now - rumbled_ns_ < rumble_ms * std::int64_t{1'000'000}) return;
        effect_.give(glm::length(felt_.get().force) / full_N_, now);
        rumbled_ns_ = now;
    }

    /// Queries the current state. Values that the gamepad does not report, as in a recording, are at rest.
    void ask() {
        state_ = {};
        for (std::size_t i = 0; i < axis_codes.size(); ++i)
            if (input_absinfo info{}; ask_axis(system_, file_, axis_codes[i], info))
                state_.axes[i] = value_of(i, info.value);
        const evdev::Bits held = evdev::Bits::of_held_keys(system_, file_);
        for (const auto& [code, bit] : button_codes)
            if (held[code]) state_.buttons |= bit;
        for (const auto& [code, bit] : roll_codes)
            if (held[code]) state_.rolls |= bit;
    }

    void read_all() {
        const int longest_ms = rumble_file_ >= 0 ? rumble_ms : poll_ms;
        while (!is_over_.load(std::memory_order_relaxed)) {
            const bool has_news = system_.wait(file_, longest_ms);
            rumble();
            if (!has_news) continue;
            input_event events[64];
            const ssize_t got = system_.read(file_, events);
            if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
            if (got < static_cast<ssize_t>(sizeof(input_event))) break;  // unplugged
            for (std::size_t n = 0; n < static_cast<std::size_t>(got) / sizeof(input_event); ++n) take(events[n]);
        }
        if (is_over_.load(std::memory_order_relaxed)) return;
        state_ = {};
        state_.is_lost = 1;
        state.write(state_);
    }

    void take(const input_event& event) {
        // The system lost events, perhaps a release: what follows up to the report is incomplete (evdev's SYN_DROPPED).
        if (event.type == EV_SYN && event.code == SYN_DROPPED) has_lost_ = true;
        if (has_lost_) {
            if (event.type != EV_SYN || event.code != SYN_REPORT) return;
            has_lost_ = false;
            ask();
        } else if (event.type == EV_ABS) {
            const auto axis = std::ranges::find(axis_codes, event.code);
            if (axis == axis_codes.end()) return;
            const auto i = static_cast<std::size_t>(axis - axis_codes.begin());
            state_.axes[i] = value_of(i, event.value);
        } else if (event.type == EV_KEY) {
            const auto set = [&](std::int64_t& bits, std::int64_t bit) {
                bits = event.value != 0 ? bits | bit : bits & ~bit;
            };
            for (const auto& [code, bit] : button_codes)
                if (code == event.code) set(state_.buttons, bit);
            for (const auto& [code, bit] : roll_codes)
                if (code == event.code) set(state_.rolls, bit);
        } else if (event.type != EV_SYN || event.code != SYN_REPORT) return;
        // Events of one report come together; states in between do no harm.
        state.write(state_);
    }

    evdev::EventSystem& system_;
    const SharedWrench& felt_;
    double full_N_;
    int file_, rumble_file_ = -1;
    evdev::ForceEffect effect_;
    std::int64_t rumbled_ns_ = 0;
    std::array<double, 8> least_{}, most_{};
    PadState state_;
    bool has_lost_ = false;
    std::atomic<bool> is_over_{false};
    std::thread thread_;
};

/// Target pose of the hand; the sticks control its velocity.
struct Steered {
    const hosted::Seqlock<PadState>* from = nullptr;
    double speed = 0.1, turn = 1.5;
    PadState state;
    Pose wanted;

    simulate::Intention operator()(double h, const Wrench& force, const Pose& hand) noexcept {
        std::uint64_t number = 0;
        from->read(state, number);
        const Twist moves = twist_of(state, speed, turn);
        wanted.position += h * moves.linear;
        wanted.orientation = glm::normalize(rotation_by(h * moves.angular) * wanted.orientation);
        const Vec3 away = wanted.position - hand.position;
        const double far = glm::length(away);
        if (glm::length(force.force) > 0.5 && far > longest_spring_m)
            wanted.position = hand.position + away * (longest_spring_m / far);
        return {wanted, moves};
    }
};

struct Settings {
    simulate::HandDynamics hand;
    DeviceInfo info;
    double speed, turn, rumble;
    std::string file;
};

class Gamepad final : public HapticDevice, public PulledDevice {
public:
    Gamepad(evdev::EventSystem& system, const Settings& settings, const std::string& path)
        : info_(settings.info), reader_(system, path, force_, settings.rumble) {
        hand_.dynamics = settings.hand;
        steered_.from = &reader_.state;
        steered_.speed = settings.speed;
        steered_.turn = settings.turn;
    }

    const DeviceInfo& info() const override { return info_; }

    void prepare(double period_s) override {
        max_tick_ = max_tick_of_hand(period_s);
        hand_.pose = {};
        hand_.twist = {};
        steered_.wanted = {};
        force_.set({});
        counter_ = 0;
    }

    DeviceSample acquire(double elapsed_s) noexcept override {
        simulate::advance(hand_, steered_, force_.get(), std::min(elapsed_s, max_tick_));
        // A lost gamepad is a fault of the device: no sample is valid any more, which fades the force.
        const bool is_here = steered_.state.is_lost == 0;
        if (is_here) pull_->write({hand_.pose, steered_.wanted, force_.get(), steady_ns()});
        return {hand_.pose, hand_.twist, static_cast<std::uint32_t>(steered_.state.buttons), ++counter_,
                is_here && is_good(hand_.pose, hand_.twist)};
    }

    void commit(const Wrench& on_hand) noexcept override { force_.set(on_hand); }

    std::shared_ptr<const PullLink> pull() const noexcept override { return pull_; }

private:
    DeviceInfo info_;
    SharedWrench force_;
    const std::shared_ptr<PullLink> pull_ = std::make_shared<PullLink>();
    PadReader reader_;
    simulate::Hand hand_;
    Steered steered_;
    double max_tick_ = 0.0;  // s
    std::int64_t counter_ = 0;
};

/// The first event device with the buttons of a gamepad; empty: none.
std::string first_gamepad(evdev::EventSystem& system) {
    for (const std::string& path : system.devices()) {
        const int file = system.open(path, O_RDONLY | O_NONBLOCK);
        if (file < 0) continue;
        const bool found = evdev::Bits::of_kind(system, file, EV_KEY)[BTN_SOUTH];
        system.close(file);
        if (found) return path;
    }
    return {};
}

Settings read_settings(Options& options) {
    const bool is_given = options.has("grip") || options.has("stiffness");
    simulate::HandDynamics hand = read_hand(options);
    if (!is_given) hand.stiffness = 2000.0;
    if (!is_given && !options.has("damping")) hand.damping = 30.0;
    DeviceInfo info = read_info_without_motors(options, hand, "gamepad");
    Settings settings{hand,
                      std::move(info),
                      options.quantity("speed", "100 mm/s", "1 mm/s", "500 mm/s"),
                      options.quantity("turn", "1.5 rad/s", "0.01 rad/s", "10 rad/s"),
                      options.quantity("rumble", "10 N", "0 N", "200 N"),
                      options.text("file", "")};
    options.finish();
    return settings;
}

}  // namespace

Twist twist_of(const PadState& state, double speed, double turn) noexcept {
    const auto axis = [&](std::size_t n) { return beyond_dead_zone(state.axes[n]); };
    const double roll = static_cast<double>(state.rolls >> 1 & 1) - static_cast<double>(state.rolls & 1);
    // Sticks count downwards.
    return {speed * Vec3(axis(0), axis(5) - axis(4), -axis(1)), turn * Vec3(-axis(3), roll, axis(2))};
}

std::unique_ptr<HapticDevice> open_gamepad_of(evdev::EventSystem& system, Options& options) {
    const Settings settings = read_settings(options);
    const std::string path = settings.file.empty() ? first_gamepad(system) : settings.file;
    if (path.empty())
        throw Error(options.where(),
                    fmt::format("{}: there is no gamepad in /dev/input that you may read; plug one in, "
                                "or give its event device as 'file'",
                                options.owner()));
    try {
        return std::make_unique<Gamepad>(system, settings, path);
    } catch (const Error& error) {
        throw Error(options.where("file"), fmt::format("{}: {}", options.owner(), error.message()));
    }
}

std::unique_ptr<HapticDevice> open_gamepad(Options& options, const PathResolver&) {
    return open_gamepad_of(evdev::linux_events(), options);
}

HardwareOutline describe_gamepad(Options& options, const PathResolver&) {
    const Settings settings = read_settings(options);
    std::error_code ignored;
    const bool is_here =
        settings.file.empty() ? !first_gamepad(evdev::linux_events()).empty() : fs::exists(settings.file, ignored);
    return {settings.info, is_here                 ? ""
                           : settings.file.empty() ? "there is no gamepad in /dev/input"
                                                   : fmt::format("there is no {}", settings.file)};
}

}  // namespace tactus::haptic
