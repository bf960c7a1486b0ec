// SPDX-License-Identifier: Apache-2.0
#include "devices/gripper/simulated_gripper.hpp"

#include "dsp/simulate/gripper/finger.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tactus::gripper {

namespace {

enum class PlantedFault : std::size_t { none, nan, stuck, unplugged };

/// A simulated fault with a start and an end, to test the reaction of a patch.
struct Breakage {
    PlantedFault kind = PlantedFault::none;
    double from = 0.0, until = 0.0;  ///< s

    bool holds(double time) const noexcept { return kind != PlantedFault::none && time >= from && time < until; }
};

class SimulatedGripper final : public HapticDevice {
public:
    SimulatedGripper(DeviceInfo info, std::vector<simulate::Finger> fingers, Breakage breakage)
        : info_(std::move(info)), initial_(std::move(fingers)), fingers_(initial_), breakage_(breakage) {}

    const DeviceInfo& info() const override { return info_; }

    void prepare(double) override {
        fingers_ = initial_;
        sample_ = {};
        drive_ = {};
        time_ = 0.0;
    }

    DeviceSample acquire(double elapsed_s) noexcept override {
        time_ += elapsed_s;
        const bool broken = breakage_.holds(time_);
        for (std::size_t i = 0; i < fingers_.size(); ++i) {
            simulate::Finger& finger = fingers_[i];
            const bool stands = broken && breakage_.kind == PlantedFault::stuck;
            finger.advance(stands ? 0.0 : drive_.speed[i], i == 0 ? drive_.cord : 0.0, elapsed_s, drive_.free);
            const auto index = static_cast<std::uint64_t>(sample_.counter);
            FingerSample& told = sample_.fingers[i];
            told.position = finger.encoder(finger.position, index);
            told.force = finger.gauge(finger.force, index);
            told.state = (finger.slipped ? motor_slips : 0) | (finger.limited() ? motor_limited : 0);
        }
        sample_.valid = true;
        if (broken && breakage_.kind == PlantedFault::nan)
            sample_.fingers[0].force = std::numeric_limits<double>::quiet_NaN();
        if (broken && breakage_.kind == PlantedFault::unplugged) sample_.valid = false;
        else ++sample_.counter;
        return sample_;
    }

    void commit(const Wrench&) noexcept override {}

    void drive(const MotorDrive& wanted) noexcept override {
        drive_ = wanted;
        for (double& speed : drive_.speed)
            if (!std::isfinite(speed)) speed = 0.0;
        if (!std::isfinite(drive_.cord)) drive_.cord = fingers_.front().cord();
    }

private:
    DeviceInfo info_;
    std::vector<simulate::Finger> initial_, fingers_;
    Breakage breakage_;
    DeviceSample sample_;
    MotorDrive drive_;
    double time_ = 0.0;
};

/// Base of both grippers.
simulate::Finger read_finger(Options& options) {
    static const std::array<std::string, 2> holders{"rig", "hand"};
    simulate::Finger finger;
    finger.on_rig = options.choice("held_by", holders, "rig") == 0;
    finger.rig.stiffness = options.quantity("spring", "0.19 N/mm", "0 N/mm", "10 N/mm");
    finger.rig.pretension = options.quantity("pretension", "35 mm", "0 mm", "1 m");
    finger.hand_stiffness = options.quantity("hand_stiffness", "0.3 N/mm", "0 N/mm", "10 N/mm");
    finger.squeeze.travel = options.quantity("squeeze", "30 mm", "0 mm", "200 mm");
    finger.squeeze.from = options.quantity("squeeze_from", "1 s", "0 s");
    finger.squeeze.until = options.quantity("squeeze_until", "1e9 s", "0 s");
    finger.squeeze.rise = options.quantity("squeeze_rise", "0.4 s", "0.01 s", "100 s");
    finger.squeeze.period = options.quantity("squeeze_period", "0 s", "0 s", "1e9 s");
    if (finger.squeeze.period > 0.0 && finger.squeeze.period < finger.squeeze.until + finger.squeeze.rise)
        throw Error(options.where("squeeze_period"),
                    options.owner() +
                        ": option 'squeeze_period' ends before the finger is open again; lengthen it, or "
                        "shorten 'squeeze_until'");
    finger.gauge.step = options.quantity("gauge_step", "5 mN", "0 mN", "1 N");
    finger.gauge.noise = options.quantity("gauge_noise", "10 mN", "0 mN", "1 N");
    finger.gauge.random.seed = static_cast<std::uint64_t>(options.quantity("seed", "1", "0", "4294967295"));
    const double delay = options.quantity("delay", "1", "0", "8");
    if (delay != std::floor(delay))
        throw Error(options.where("delay"), options.owner() + ": option 'delay' must be a whole number of ticks");
    finger.delay = static_cast<int>(delay);
    return finger;
}

Breakage read_breakage(Options& options) {
    static const std::array<std::string, 4> kinds{"none", "nan", "stuck", "unplugged"};
    Breakage breakage;
    breakage.kind = static_cast<PlantedFault>(options.choice("fault", kinds, "none"));
    breakage.from = options.quantity("fault_at", "1 s", "0 s");
    breakage.until = options.quantity("fault_until", "1e9 s", "0 s");
    return breakage;
}

DeviceInfo describe_gripper(std::string name, int fingers, double max_speed, double least_speed) {
    DeviceInfo info;
    info.name = std::move(name);
    info.fingers = fingers;
    info.max_speed = max_speed;
    info.least_speed = least_speed;
    return info;
}

}  // namespace

std::unique_ptr<HapticDevice> open_walking_gripper(Options& options, const haptic::PathResolver&) {
    simulate::Finger finger = read_finger(options);
    simulate::WalkingMotorSettings s;
    s.leverage = options.quantity("leverage", "4.5", "0.1", "100");
    s.drive_limit = options.quantity("drive_limit", "3 kHz", "1 Hz", "100 kHz");
    const double fastest = options.quantity("max_speed", "70 mm/s", "0.1 mm/s", "10 m/s");
    s.step = fastest / s.leverage / s.drive_limit;
    s.lag = options.quantity("lag", "2 ms", "0 ms", "100 ms");
    s.holding_force = options.quantity("holding_force", "4.4 N", "0 N", "1000 N");
    s.slip_damping = options.quantity("slip_damping", "20 N s/m", "0.1 N s/m", "1000 N s/m");
    const double pulses = options.quantity("encoder", "16000 mm^-1", "0.01 mm^-1", "1e7 mm^-1");
    const Breakage breakage = read_breakage(options);
    options.finish();
    finger.motor = simulate::WalkingMotor{s};
    finger.encoder.step = s.leverage / pulses;  // the encoder measures the rod
    return std::make_unique<SimulatedGripper>(
        describe_gripper("simulated gripper, walking motor", 1, s.max_speed(), 0.0), std::vector{finger}, breakage);
}

std::unique_ptr<HapticDevice> open_wave_gripper(Options& options, const haptic::PathResolver&) {
    static const std::array<std::string, 3> controls{"phase", "frequency", "amplitude"};
    static constexpr std::array control_of{simulate::WaveControl::phase, simulate::WaveControl::frequency,
                                           simulate::WaveControl::amplitude};
    simulate::Finger finger = read_finger(options);
    simulate::WaveMotor motor;
    simulate::WaveMotorSettings& s = motor.settings;
    s.resonance = options.quantity("resonance", "40 kHz", "1 kHz", "1 MHz");
    s.width = options.quantity("width", "800 Hz", "1 Hz", "100 kHz");
    s.max_speed = options.quantity("max_speed", "600 mm/s", "1 mm/s", "10 m/s");
    s.least_speed = options.quantity("least_speed", "30 mm/s", "0 mm/s", "1 m/s");
    s.dead_zone = options.quantity("dead_zone", "15 mm/s", "0 mm/s", "1 m/s");
    s.lag = options.quantity("lag", "4 ms", "0 ms", "100 ms");
    s.holding_force = options.quantity("holding_force", "3 N", "0 N", "1000 N");
    s.slip_damping = options.quantity("slip_damping", "20 N s/m", "0.1 N s/m", "1000 N s/m");
    s.low_friction = options.quantity("low_friction", "1.5 N s/m", "0.1 N s/m", "1000 N s/m");
    motor.control = control_of[options.choice("control", controls, "phase")];
    const double lever = options.quantity("lever", "70 mm", "1 mm", "1 m");
    const double pulses = options.quantity("encoder", "4000", "1", "1e8");
    const Breakage breakage = read_breakage(options);
    options.finish();
    finger.motor = motor;
    finger.encoder.step = 2.0 * std::numbers::pi * lever / pulses;
    simulate::Finger thumb = finger;
    thumb.gauge.random.seed += 1;
    return std::make_unique<SimulatedGripper>(
        describe_gripper("simulated gripper, traveling-wave motors", 2, s.max_speed, s.least_speed),
        std::vector{finger, thumb}, breakage);
}

}  // namespace tactus::gripper
