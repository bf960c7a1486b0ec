// SPDX-License-Identifier: Apache-2.0
// A gripper with a controller on a serial port. Protocol: devices/gripper/frame.hpp.
#pragma once

#include "devices/gripper/frame.hpp"
#include "devices/gripper/serial_port.hpp"
#include "devices/haptic/catalogue.hpp"
#include "dsp/simulate/gripper/sensors.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace tactus::gripper {

struct SerialGripperSettings {
    std::string port;              ///< "/dev/ttyUSB0"
    int baud = 115200;
    int fingers = 1;
    double pulse = 4.5e-3 / 16e3;  ///< m of the finger per pulse of its encoder
    std::array<simulate::LineFit, 2> gauge{{{1e-3, 0.0, 1.0, 0.0}, {1e-3, 0.0, 1.0, 0.0}}};  ///< counts to N
    double max_speed = 0.07;       ///< m/s
    double least_speed = 0.0;      ///< m/s; slowest speed of the motor
    double timeout = 0.02;         ///< s without a valid sample until the device is invalid
    double reopen_every = 0.25;    ///< s between attempts to reopen a lost line
};

/// Returns the device properties that follow from its settings.
DeviceInfo info_of(const SerialGripperSettings& settings);

class SerialGripper final : public HapticDevice {
public:
    struct Counts {
        std::uint64_t lost = 0, repeated = 0, unsent = 0, reopened = 0;
    };

    /// Opens the line. Throws Error.
    explicit SerialGripper(SerialGripperSettings settings);
    /// Makes the motors hold.
    ~SerialGripper() override;

    const DeviceInfo& info() const override { return info_; }
    void prepare(double period_s) override;
    DeviceSample acquire(double elapsed_s) noexcept override;
    void commit(const Wrench&) noexcept override {}
    void drive(const MotorDrive& wanted) noexcept override;

    const Counts& counts() const noexcept { return counts_; }
    const FrameReader::Counts& frames() const noexcept { return reader_.counts(); }

private:
    void listen(double elapsed_s) noexcept;
    void accept(const Frame& frame) noexcept;
    void send(const DriveFrame& drive) noexcept;

    SerialGripperSettings settings_;
    DeviceInfo info_;
    SerialPort port_;
    FrameReader reader_;
    DeviceSample sample_;
    Counts counts_;
    double silent_for_ = 1e9, until_reopen_ = 0.0;  // s
    std::uint16_t sent_ = 0, received_ = 0;
    bool has_sample_ = false;
};

/// Options: port, baud, fingers, encoder (pulses per m of the finger), newton_per_count, or calibration and
/// thumb_calibration (assets; see load_force_calibration), max_speed, least_speed, timeout. Throws Error.
std::unique_ptr<HapticDevice> open_serial_gripper(Options& options, const haptic::PathResolver& resolve);
/// The same without opening the line.
haptic::HardwareOutline describe_serial_gripper(Options& options, const haptic::PathResolver& resolve);

}  // namespace tactus::gripper
