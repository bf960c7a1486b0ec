// SPDX-License-Identifier: Apache-2.0
#include "devices/gripper/serial_gripper.hpp"

#include "assets/table/deflection_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace tactus::gripper {

namespace {

/// A sequence number further back than this means that the controller was restarted.
constexpr int longest_step_back = 1000;

std::int32_t micro(double si) noexcept {
    return static_cast<std::int32_t>(std::lround(std::clamp(si * 1e6, -2e9, 2e9)));
}

}  // namespace

DeviceInfo info_of(const SerialGripperSettings& settings) {
    DeviceInfo info;
    info.name = fmt::format("gripper at {}", settings.port);
    info.fingers = settings.fingers;
    info.max_speed = settings.max_speed;
    info.least_speed = settings.least_speed;
    return info;
}

SerialGripper::SerialGripper(SerialGripperSettings settings)
    : settings_(std::move(settings)), info_(info_of(settings_)) {
    if (const std::string why = port_.open(settings_.port, settings_.baud); !why.empty()) throw Error(why);
}

SerialGripper::~SerialGripper() {
    for (int again = 0; again < 3; ++again) send({});
}

void SerialGripper::prepare(double) {
    silent_for_ = 1e9;
    has_sample_ = false;
    sample_ = {};
}

DeviceSample SerialGripper::acquire(double elapsed_s) noexcept {
    listen(elapsed_s);
    sample_.valid = has_sample_ && silent_for_ <= settings_.timeout;
    return sample_;
}

void SerialGripper::listen(double elapsed_s) noexcept {
    silent_for_ += elapsed_s;
    if (!port_.is_open()) {
        has_sample_ = false;
        until_reopen_ -= elapsed_s;
        if (until_reopen_ > 0.0) return;
        until_reopen_ = settings_.reopen_every;
        if (!port_.open(settings_.port, settings_.baud).empty()) return;
        ++counts_.reopened;
    }
    std::array<std::uint8_t, 512> arrived;
    // Limits the bytes per tick, so that a flooded line cannot delay it.
    for (int piece = 0; piece < 8; ++piece) {
        const std::size_t count = port_.read(arrived);
        for (std::size_t i = 0; i < count; ++i)
            if (reader_.take(arrived[i])) accept(reader_.frame());
        if (count < arrived.size()) return;
    }
}

void SerialGripper::accept(const Frame& frame) noexcept {
    SampleFrame told;
    if (!unpack(frame, told)) return;
    if (has_sample_) {
        const int step = static_cast<std::int16_t>(static_cast<std::uint16_t>(frame.sequence - received_));
        if (step <= 0 && step > -longest_step_back) {
            ++counts_.repeated;
            return;
        }
        if (step > 1) counts_.lost += static_cast<std::uint64_t>(step - 1);
    }
    received_ = frame.sequence;
    has_sample_ = true;
    silent_for_ = 0.0;
    ++sample_.counter;
    for (std::size_t i = 0; i < max_fingers; ++i)
        sample_.fingers[i] = {told.encoder[i] * settings_.pulse, settings_.gauge[i](told.gauge[i]),
                              (told.slips[i] ? motor_slips : 0) | (told.limited[i] ? motor_limited : 0)};
}

void SerialGripper::drive(const MotorDrive& wanted) noexcept {
    DriveFrame frame;
    frame.run = std::isfinite(wanted.speed[0]) && std::isfinite(wanted.speed[1]) && std::isfinite(wanted.cord);
    if (frame.run) {
        for (std::size_t i = 0; i < max_fingers; ++i)
            frame.speed_um_s[i] = micro(std::clamp(wanted.speed[i], -settings_.max_speed, settings_.max_speed));
        frame.cord_um = micro(wanted.cord);
        frame.free = wanted.free;
    }
    send(frame);
}

void SerialGripper::send(const DriveFrame& drive) noexcept {
    const FrameBytes bytes = encode(pack(drive, ++sent_));
    if (!port_.send({bytes.bytes.data(), bytes.size})) ++counts_.unsent;
}

namespace {

SerialGripperSettings read_settings(Options& options, const haptic::PathResolver& resolve) {
    SerialGripperSettings s;
    s.port = options.text("port", "/dev/ttyUSB0");
    const double baud = options.quantity("baud", "115200", "9600", "1000000");
    s.baud = static_cast<int>(baud);
    if (s.baud != baud || !SerialPort::knows_baud(s.baud))
        throw Error(options.where("baud"), fmt::format("{}: option 'baud' is not a standard rate", options.owner()));
    s.fingers = static_cast<int>(options.quantity("fingers", "1", "1", "2"));
    s.pulse = 1.0 / options.quantity("encoder", "3555.6 mm^-1", "0.01 mm^-1", "1e7 mm^-1");
    const double newton = options.quantity("newton_per_count", "1 mN", "1e-9 N", "100 N");
    for (simulate::LineFit& gauge : s.gauge) gauge.slope = newton;
    const std::array<std::string, 2> calibrations{options.text("calibration", ""),
                                                  options.text("thumb_calibration", "")};
    s.max_speed = options.quantity("max_speed", "70 mm/s", "0.1 mm/s", "10 m/s");
    s.least_speed = options.quantity("least_speed", "0 mm/s", "0 mm/s", "1 m/s");
    s.timeout = options.quantity("timeout", "20 ms", "1 ms", "10 s");
    options.finish();
    for (std::size_t i = 0; i < calibrations.size(); ++i)
        if (!calibrations[i].empty()) s.gauge[i] = table::load_force_calibration(resolve(calibrations[i]));
    return s;
}

}  // namespace

haptic::HardwareOutline describe_serial_gripper(Options& options, const haptic::PathResolver& resolve) {
    const SerialGripperSettings settings = read_settings(options, resolve);
    std::error_code ignored;
    const bool is_here = std::filesystem::exists(settings.port, ignored);
    return {info_of(settings), is_here ? "" : fmt::format("there is no {}", settings.port)};
}

std::unique_ptr<HapticDevice> open_serial_gripper(Options& options, const haptic::PathResolver& resolve) {
    SerialGripperSettings settings = read_settings(options, resolve);
    try {
        return std::make_unique<SerialGripper>(std::move(settings));
    } catch (const Error& error) {
        throw Error(options.where("port"), fmt::format("{}: {}", options.owner(), error.message()));
    }
}

}  // namespace tactus::gripper
