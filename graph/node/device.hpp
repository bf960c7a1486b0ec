// SPDX-License-Identifier: Apache-2.0
// Interfaces of haptic devices and sound outputs. Drivers are in devices/ and are opened by name.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace tactus {

/// Bits of `DeviceSample::buttons`.
inline constexpr std::uint32_t button_trigger = 1u;  ///< the tool runs while this button is held

/// Bits of `FingerSample::state`.
inline constexpr std::uint64_t motor_slips = 1u;    ///< the load moves the finger against the motor
inline constexpr std::uint64_t motor_limited = 2u;  ///< the commanded speed exceeds the motor's maximum

/// One finger of a gripper. A motor moves it and a sensor measures the force of the hand (an admittance-type device).
struct FingerSample {
    double position = 0.0;  ///< m along the path of the finger, positive towards closed
    double force = 0.0;     ///< N exerted by the hand, positive towards closed
    std::uint64_t state = 0;  ///< bits, see above
};

inline constexpr std::size_t max_fingers = 2;

/// What a device reports in one tick, in the device frame: m, rad, m/s, rad/s.
struct DeviceSample {
    Pose pose;
    Twist twist;                 ///< velocity of the pose's origin, along the axes of the device frame
    std::uint32_t buttons = 0;
    std::int64_t counter = 0;  ///< increases with each fresh sample; an unchanged number marks an old one
    bool valid = false;  ///< false: ignore the other members
    bool taken = false;  ///< set by the engine: ticks were late and the watchdog faded the force; ramp it in again
    bool sound_lost = false;  ///< set by the engine once when a sound card is lost: fade the force and ramp it in again
    bool late = false;  ///< set by a driver that received no pose of the hand in time; handled like a late tick
    std::array<FingerSample, max_fingers> fingers{};  ///< of a gripper
};
static_assert(std::is_trivially_destructible_v<DeviceSample>, "samples travel through rings");

/// True when a force may be computed from this motion: finite, with a quaternion of unit length.
inline bool is_good(const Pose& pose, const Twist& twist) noexcept {
    return is_valid(pose) && is_finite(twist.linear) && is_finite(twist.angular);
}
/// The same for a sample that the driver marks as valid. Drivers, the engine and all nodes use this predicate and no
/// other: if they differed, device_input could freeze the pose while device_output detects no fault.
inline bool is_good(const DeviceSample& sample) noexcept { return sample.valid && is_good(sample.pose, sample.twist); }

/// Properties of a device. Zero means none or unknown.
struct DeviceInfo {
    std::string name;
    double max_force = 0.0;  ///< N
    double max_torque = 0.0;  ///< N·m
    double damping = 0.0;  ///< N·s/m, of the mechanism with a hand on it; it limits the stable stiffness
    double max_stiffness = 0.0;  ///< N/m, as stated by the manufacturer
    double resolution = 0.0;  ///< m, step of the reported position
    double angular_resolution = 0.0;  ///< rad, step of the reported orientation
    double delay = 0.0;  ///< s, from a motion of the hand to the resulting force
    bool actuates_torque = false;
    bool senses_rotation = false;
    /// True if no person feels the forces: they push only the simulated hand of a mouse or a gamepad, or nothing.
    /// `max_force` is then the strength of that hand.
    bool without_motors = false;
    int fingers = 0;  ///< number of motorised fingers; 0: not a gripper
    double max_speed = 0.0;  ///< m/s of a finger
    double least_speed = 0.0;  ///< m/s; slowest speed of the motor other than standstill
};

/// Commands for the motors of a gripper, and for the servo of a test rig that holds it, for the next period.
struct MotorDrive {
    std::array<double, max_fingers> speed{};  ///< m/s, positive towards closed
    double cord = 0.0;  ///< m, position of the rig's cord at the end of the period
    bool free = false;  ///< true: low-friction mode, if the motor has one, in which the hand moves the finger
};

/// A haptic device. In each tick of its group one thread calls `acquire`, runs the nodes, and calls `commit`. A driver
/// may block and make system calls in both.
class HapticDevice {
public:
    virtual ~HapticDevice() = default;

    virtual const DeviceInfo& info() const = 0;

    /// Sets the nominal tick period in s and resets the device to its initial state. May allocate. Throws Error.
    virtual void prepare(double period_s) = 0;

    /// Reads the device, once per activation. `elapsed_s` is the logical time since the last call in s: one period,
    /// more after skipped ticks, 0 at the first call.
    virtual DeviceSample acquire(double elapsed_s) noexcept = 0;

    /// Sets the force on the hand until the next call: N, N·m, device frame, about the origin of the pose. If the tick
    /// thread hangs, even inside `acquire`, another thread calls this to fade the force. Calls never overlap.
    virtual void commit(const Wrench& on_hand) noexcept = 0;

    /// Sets the speeds of a gripper's motors until the next call. Only the thread of the tick calls it, after `commit`.
    /// The driver must stop the motors by itself when the calls stop.
    virtual void drive(const MotorDrive&) noexcept {}
};

/// Counts of an audio output since `prepare`.
struct AudioStatistics {
    std::uint64_t frames_written = 0;  ///< accepted by `write`
    std::uint64_t frames_dropped = 0;  ///< refused by `write` because the buffer was full
    std::uint64_t frames_underflowed = 0;  ///< played as silence because the buffer was empty
    std::uint64_t underflows = 0;  ///< times the buffer ran empty
    std::uint64_t frames_left_out = 0;  ///< accepted, then skipped because the buffer held too much
};

/// State of the card's clock: at `steady_ns` of std::chrono::steady_clock the card had requested `frames` frames in
/// total. Both are 0 until its first request.
struct AudioProgress {
    std::int64_t frames = 0;
    std::int64_t steady_ns = 0;
    std::int64_t taken = 0;  ///< frames that left the buffer, played or skipped
    std::int64_t largest = 0;  ///< largest number of frames in one request
    bool waits = false;  ///< the card waits for the engine (JACK in freewheel), so its clock is not valid
};

/// An audio output.
class AudioSink {
public:
    virtual ~AudioSink() = default;

    virtual const std::string& name() const = 0;

    /// Opens the output with `rate` Hz and one channel per name, in this order. Patch bays show the names that are not
    /// empty. May allocate and take seconds. Throws Error with the reason.
    virtual void prepare(double rate, const std::vector<std::string>& channels) = 0;

    /// Adds interleaved frames to the buffer, full scale ±1. Returns the number accepted. Never waits for the card.
    virtual std::size_t write(const float* interleaved, std::size_t frames) noexcept = 0;

    /// Frames that `write` would accept now.
    virtual std::size_t writable() const noexcept = 0;

    virtual AudioStatistics statistics() const noexcept = 0;
    virtual AudioProgress progress() const noexcept = 0;

    /// Skips the next `frames` frames of the buffer instead of playing them. Any thread may call it.
    virtual void leave_out(std::int64_t frames) noexcept = 0;

    /// Plays the rest of the buffer, then releases the card. Only the control thread calls it, never while another
    /// thread is in `write`. Takes at most a few seconds, even when the card does not answer.
    virtual void close() = 0;
};

}  // namespace tactus
