// SPDX-License-Identifier: Apache-2.0
#include "devices/spacenav/space_mouse.hpp"

#include "devices/driver/buttons.hpp"
#include "devices/driver/peer_socket.hpp"
#include "devices/haptic/operated.hpp"
#include "devices/spacenav/events.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/simulate/hand.hpp"

#include <fmt/format.h>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

namespace tactus::spacenav {

namespace {

constexpr double full_deflection = 350.0;
constexpr double longest_step_s = 0.05;

struct Settings {
    std::string socket;
    double speed = 0.1, turn_speed = 1.0, reach = 0.15;  // m/s, rad/s, m
    simulate::HandDynamics hand;
    DeviceInfo info;
};

/// The daemon has x to the right, y up, z away from the user: a left-handed frame, so that turns change their sign.
Vec3 shift_of(const CapState& cap) noexcept {
    const auto& d = cap.deflection;
    return Vec3(d[0], d[2], d[1]) / full_deflection;
}
Vec3 turn_of(const CapState& cap) noexcept {
    const auto& d = cap.deflection;
    return Vec3(-d[3], -d[5], -d[4]) / full_deflection;
}

/// Target pose of the hand, integrated from the velocities of the cap.
struct Steered {
    Pose wanted;
    Twist twist;
    double reach = 0.15;

    simulate::Intention operator()(double h, const Wrench&, const Pose&) noexcept {
        const Vec3 next = wanted.position + twist.linear * h;
        wanted.position = glm::clamp(next, Vec3(-reach), Vec3(reach));
        wanted.orientation = glm::normalize(rotation_by(twist.angular * h) * wanted.orientation);
        return {wanted, {(wanted.position == next ? twist.linear : Vec3(0.0)), twist.angular}};
    }
};

class SpaceMouse final : public driver::Backend {
public:
    explicit SpaceMouse(Settings settings) : settings_(std::move(settings)) {
        hand_.dynamics = settings_.hand;
        steered_.reach = settings_.reach;
    }
    ~SpaceMouse() override { close(); }
    SpaceMouse(const SpaceMouse&) = delete;
    SpaceMouse& operator=(const SpaceMouse&) = delete;

    driver::Outline outline() const override {
        const bool is_there = ::access(settings_.socket.c_str(), F_OK) == 0;
        return {settings_.info, is_there ? "" : fmt::format("there is no {}", settings_.socket)};
    }

    driver::Opened open(driver::OpenMode, const std::shared_ptr<driver::Exchange>&,
                        const driver::StepLog& step) override {
        step("connect to " + settings_.socket);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        if (settings_.socket.size() >= sizeof address.sun_path)
            throw Error(fmt::format("{} is too long a name for a socket", settings_.socket));
        std::memcpy(address.sun_path, settings_.socket.data(), settings_.socket.size());
        file_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        if (file_ < 0 || ::connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
            throw Error(fmt::format("no answer at {}: {}; is spacenavd installed and running?", settings_.socket,
                                    std::strerror(errno)));
        [[maybe_unused]] const auto asked =
            ::send(file_, &ask_for_devices, sizeof ask_for_devices, MSG_NOSIGNAL | MSG_DONTWAIT);
        reader_ = {};
        last_ns_ = 0;
        driver::Opened opened;
        opened.info = settings_.info;
        opened.serial = "spacenavd";
        opened.versions = {"socket " + settings_.socket};
        return opened;
    }

    bool round(driver::Exchange& exchange) noexcept override {
        std::array<std::uint8_t, 1024> bytes;
        const std::optional<std::size_t> count = driver::read_now(file_, bytes);
        if (!count) return false;
        const std::int64_t now = boot_ns(), elapsed_ns = last_ns_ == 0 ? 0 : now - last_ns_;
        last_ns_ = now;
        reader_.pass(elapsed_ns);
        reader_.take(std::span(bytes).first(*count));
        const double elapsed = static_cast<double>(elapsed_ns) * 1e-9;
        const CapState& cap = reader_.state();
        steered_.twist = {shift_of(cap) * settings_.speed, turn_of(cap) * settings_.turn_speed};
        const Wrench force = exchange.force();
        simulate::advance(hand_, steered_, force, std::clamp(elapsed, 0.0, longest_step_s));
        exchange.pull.write({hand_.pose, steered_.wanted, force, steady_ns()});
        driver::Reading reading;
        reading.pose = hand_.pose;
        reading.twist = hand_.twist;
        reading.has_twist = true;
        reading.buttons = driver::buttons_of_mask(cap.buttons);
        exchange.publish(reading);
        return true;
    }

    void close() noexcept override {
        if (file_ >= 0) ::close(std::exchange(file_, -1));
    }

    std::int64_t round_ns() const noexcept override { return 1'000'000; }
    bool is_peer() const noexcept override { return true; }

private:
    Settings settings_;
    int file_ = -1;
    EventReader reader_;
    simulate::Hand hand_;
    Steered steered_;
    std::int64_t last_ns_ = 0;
};

}  // namespace

std::unique_ptr<driver::Backend> make_space_mouse(Options& options) {
    Settings settings;
    const char* const socket = std::getenv("SPNAV_SOCKET");
    settings.socket = options.text("socket", socket && *socket ? socket : "/var/run/spnav.sock");
    settings.speed = options.quantity("speed", "100 mm/s", "1 mm/s", "1 m/s");
    settings.turn_speed = options.quantity("turn_speed", "1 rad/s", "0.01 rad/s", "10 rad/s");
    settings.reach = options.quantity("reach", "150 mm", "1 mm", "1 m");
    const bool is_given = options.has("grip") || options.has("stiffness");
    settings.hand = haptic::read_hand(options);
    if (!is_given) settings.hand.stiffness = 2000.0;
    if (!is_given && !options.has("damping")) settings.hand.damping = 30.0;
    settings.info = haptic::read_info_without_motors(options, settings.hand, "hand at a 3D mouse");
    return std::make_unique<SpaceMouse>(std::move(settings));
}

}  // namespace tactus::spacenav
