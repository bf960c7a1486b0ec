// SPDX-License-Identifier: Apache-2.0
#include "devices/board/serial_board.hpp"

#include "devices/board/lines.hpp"
#include "devices/board/mechanism.hpp"
#include "devices/driver/buttons.hpp"
#include "devices/gripper/serial_port.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/constants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace tactus::board {

namespace {

namespace fs = std::filesystem;

constexpr std::int64_t longest_opening_ns = 2'500'000'000, longest_silence_ns = 500'000'000;
constexpr std::int64_t ms = 1'000'000, longest_patience_ns = 10 * ms;

struct Settings {
    std::string name, port, serial;
    int baud = 115200;
    Mechanism mechanism = Mechanism::sector(0.07);
    std::string setup;        ///< what decides in which direction a push goes
    bool are_motors_far = true;
    double max_torque = 0.1, max_force = 2.0;
};

/// Serial ports of this machine, for the error about a path that is not one.
std::string lines_here() {
    std::string names;
    std::error_code failure;
    for (fs::directory_iterator at("/dev", failure), end; !failure && at != end; at.increment(failure))
        if (const std::string name = at->path().filename(); name.starts_with("ttyACM") || name.starts_with("ttyUSB"))
            names += (names.empty() ? "" : ", ") + at->path().string();
    return names.empty() ? "no board is plugged in: there is no /dev/ttyACM* or /dev/ttyUSB*"
                         : fmt::format("give its line as 'port'; here are: {}", names);
}

class SerialBoard final : public driver::Backend {
public:
    SerialBoard(Settings settings, std::unique_ptr<Protocol> protocol)
        : settings_(std::move(settings)), protocol_(std::move(protocol)) {}

    driver::Outline outline() const override {
        std::error_code ignored;
        const bool is_here = fs::exists(settings_.port, ignored);
        return {info(), is_here ? "" : fmt::format("there is no {}", settings_.port)};
    }

    driver::Opened open(driver::OpenMode mode, const std::shared_ptr<driver::Exchange>&,
                        const driver::StepLog& step) override {
        step("open " + settings_.port);
        if (const std::string why = port_.open(settings_.port, settings_.baud); !why.empty())
            throw Error(fmt::format("{}; {}", why, lines_here()));
        protocol_->reset();
        gives_ = mode == driver::OpenMode::run;
        heard_ns_ = steady_ns();
        const std::uint64_t before = count_ = protocol_->told().count;
        step("wait for an answer of the board");
        const std::vector<std::uint8_t> hello = protocol_->greeting();
        for (const std::int64_t end = steady_ns() + longest_opening_ns; protocol_->told().count == before;) {
            if (steady_ns() > end)
                throw Error(
                    fmt::format("the board at {} does not answer; is it the right port, and does the board run "
                                "the right program?",
                                settings_.port));
            if (!hello.empty()) port_.send(hello);
            // Some boards reset when the port is opened; repeat the request until they answer.
            for (int i = 0; i < 50 && protocol_->told().count == before; ++i) {
                if (may_ask()) ask({}, false);
                sleep_for(2 * ms);
                if (!listen()) throw Error("the line was lost");
            }
        }
        driver::Opened opened;
        opened.info = info();
        opened.serial = serial();
        opened.setup = settings_.setup;
        opened.versions = {"line " + settings_.port};
        opened.axes = settings_.mechanism.motors();
        return opened;
    }

    bool round(driver::Exchange& exchange) noexcept override {
        if (!listen()) return false;
        const std::int64_t now = steady_ns();
        const Told& told = protocol_->told();
        if (told.count != count_) {
            count_ = told.count;
            heard_ns_ = now;
            publish(exchange, told);
        }
        const Vec3 force = gives_ ? to_mechanism(exchange.force().force) : Vec3(0.0);
        // The pose of a silent board is unknown, and the Jacobian of its last pose no longer applies.
        const bool is_fresh = now - heard_ns_ < driver::Exchange::oldest_sample_ns;
        if (may_ask())
            ask(is_fresh ? limited(settings_.mechanism.torques(told.angle, force)) : std::array<double, 2>{}, is_fresh);
        return port_.is_open() && now - heard_ns_ < longest_silence_ns;
    }

    void close() noexcept override {
        if (!port_.is_open()) return;
        for (int again = 0; again < 3; ++again) ask({}, false);
        port_.close();
    }

    std::int64_t round_ns() const noexcept override { return ms; }
    bool is_peer() const noexcept override { return true; }

private:
    // The plane of the mechanism lies on the table, the motors on the far side of the handle or on the near one.
    Vec3 from_mechanism(const Vec3& v) const noexcept { return settings_.are_motors_far ? -v : v; }
    Vec3 to_mechanism(const Vec3& v) const noexcept { return settings_.are_motors_far ? -v : v; }

    DeviceInfo info() const {
        DeviceInfo info;
        info.name = settings_.name;
        info.max_force = settings_.max_force;
        info.max_stiffness = 300.0;
        info.resolution = 20e-6;
        // A motion just after the board was read waits for the next exchange, its force for the one after; and a round.
        info.delay = std::max(3e-3, 2.0 * protocol_->exchange_s() + 1e-3);
        return info;
    }

    std::string serial() const {
        if (!settings_.serial.empty()) return settings_.serial;
        if (protocol_->told().serial != 0) return fmt::format("{:08x}", protocol_->told().serial);
        // Linux keeps the number of a board at USB in the name of a link to its line.
        std::error_code failure;
        const fs::path line = fs::canonical(settings_.port, failure);
        if (!failure)
            for (fs::directory_iterator at("/dev/serial/by-id", failure), end; !failure && at != end;
                 at.increment(failure))
                if (std::error_code bad; fs::canonical(at->path(), bad) == line && !bad)
                    return at->path().filename().string();
        return {};
    }

    void publish(driver::Exchange& exchange, const Told& told) noexcept {
        driver::Reading reading;
        const std::optional<Vec3> at = settings_.mechanism.position(told.angle);
        reading.is_valid = at.has_value();
        if (at) reading.pose.position = from_mechanism(*at);
        reading.buttons = driver::buttons_of_mask(told.buttons);
        exchange.publish(reading);
    }

    /// Both by one factor: the direction of the force stays.
    std::array<double, 2> limited(std::array<double, 2> torque) const noexcept {
        const double most = std::max(std::abs(torque[0]), std::abs(torque[1]));
        if (most > settings_.max_torque)
            for (double& one : torque) one *= settings_.max_torque / most;
        return torque;
    }

    void ask(const std::array<double, 2>& torque, bool run) noexcept {
        asked_ns_ = steady_ns();
        asked_count_ = protocol_->told().heard;
        port_.send(protocol_->request(torque, run && gives_));
    }

    /// Also sends when the port is never silent, because the board may hold a force.
    bool may_ask() const noexcept {
        const std::int64_t now = steady_ns();
        return protocol_->told().heard != asked_count_ ||
               now - asked_ns_ >= std::max(longest_patience_ns, 2 * protocol_->patience_ns()) ||
               now - std::max(asked_ns_, byte_ns_) >= protocol_->patience_ns();
    }

    /// False when the line is lost.
    bool listen() noexcept {
        std::array<std::uint8_t, 512> bytes;
        const std::size_t count = port_.read(bytes);
        if (count > 0) {
            const std::int64_t now = steady_ns();
            protocol_->take({bytes.data(), count}, now - byte_ns_);
            byte_ns_ = now;
        }
        return port_.is_open();
    }

    Settings settings_;
    std::unique_ptr<Protocol> protocol_;
    gripper::SerialPort port_;
    std::uint64_t count_ = 0;
    std::int64_t heard_ns_ = 0, byte_ns_ = 0, asked_ns_ = 0;
    std::uint64_t asked_count_ = 0;
    bool gives_ = false;
};

Settings read_common(Options& options, const char* side, const char* max_torque, const char* max_force) {
    static const std::vector<std::string> sides{"far", "near"};
    Settings settings;
    const char* const port = std::getenv("TACTUS_BOARD_PORT");
    settings.port = options.text("port", port && *port ? port : "/dev/ttyACM0");
    settings.serial = options.text("serial", "");
    const double baud = options.quantity("baud", "115200", "9600", "1000000");
    settings.baud = static_cast<int>(baud);
    if (settings.baud != baud || !gripper::SerialPort::knows_baud(settings.baud))
        throw Error(options.where("baud"), fmt::format("{}: option 'baud' is not a standard rate", options.owner()));
    settings.are_motors_far = options.choice("motors", sides, side) == 0;
    settings.max_torque = options.quantity("max_torque", max_torque, "0.001 N m", "2 N m");
    settings.max_force = options.quantity("max_force", max_force, "0.1 N", "20 N");
    return settings;
}

Mechanism read_pantograph(Options& options, std::string& setup) {
    const double proximal = options.quantity("proximal", "50 mm", "5 mm", "500 mm");
    const double distal = options.quantity("distal", "70 mm", "5 mm", "500 mm");
    const double spacing = options.quantity("spacing", "20 mm", "0 mm", "500 mm");
    setup = fmt::format("pantograph {} {} {}", proximal, distal, spacing);
    return Mechanism::pantograph(proximal, distal, spacing);
}

}  // namespace

std::unique_ptr<driver::Backend> make_serial_board(Options& options) {
    static const std::vector<std::string> mechanisms{"sector", "pantograph"};
    Settings settings = read_common(options, "near", "0.1 N m", "1.5 N");
    settings.name = fmt::format("board at {}", settings.port);
    const bool is_sector = options.choice("mechanism", mechanisms, "sector") == 0;
    const double radius = options.quantity("radius", "70 mm", "1 mm", "500 mm");
    settings.mechanism = read_pantograph(options, settings.setup);
    if (is_sector) {
        settings.mechanism = Mechanism::sector(radius);
        settings.setup = fmt::format("sector {}", radius);
    }
    settings.setup += settings.are_motors_far ? " far" : " near";
    const int motors = settings.mechanism.motors(), baud = settings.baud;
    return std::make_unique<SerialBoard>(std::move(settings), std::make_unique<FrameProtocol>(motors, baud));
}

std::unique_ptr<driver::Backend> make_haply_2diy(Options& options) {
    Settings settings = read_common(options, "far", "0.123 N m", "2 N");
    settings.name = fmt::format("Haply 2diy at {}", settings.port);
    DiyProtocol::Settings line;
    line.offset_deg = {options.quantity("offset_1", "180 deg", "-720 deg", "720 deg") / degree,
                       options.quantity("offset_2", "0 deg", "-720 deg", "720 deg") / degree};
    line.counts = options.quantity("counts", "13824", "100", "1e6");
    settings.mechanism = read_pantograph(options, settings.setup);
    settings.setup += fmt::format(" {} {} {}{}", line.offset_deg[0], line.offset_deg[1], line.counts,
                                  settings.are_motors_far ? " far" : " near");
    return std::make_unique<SerialBoard>(std::move(settings), std::make_unique<DiyProtocol>(line));
}

}  // namespace tactus::board
