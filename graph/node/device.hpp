// SPDX-License-Identifier: Apache-2.0
// What nodes and the engine see of the outside world: a thing in a hand, and a thing that makes sound. Drivers live in
// devices/ and are opened by name; nothing here knows one.
#pragma once

#include "dsp/core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace tactus {

/// Bits of `DeviceSample::buttons`.
inline constexpr std::uint32_t button_trigger = 1u;  ///< the tool runs while it is held

/// Bits of `FingerSample::state`.
inline constexpr std::uint64_t motor_slips = 1u;    ///< the load moves the finger although the motor holds it
inline constexpr std::uint64_t motor_limited = 2u;  ///< the motor was told to run faster than it may

/// One finger part of a gripper: a device that is moved by a motor and senses force (an admittance device).
struct FingerSample {
    double position = 0.0;  ///< m along the path of the finger, towards + it closes
    double force = 0.0;     ///< N of the hand on it, towards + it closes
    std::uint64_t state = 0;
};

inline constexpr std::size_t most_fingers = 2;

/// What a device reports in one tick: device frame, m, rad, s.
struct DeviceSample {
    Pose pose;
    Twist twist;                 ///< linear at the pose's origin, along the axes of the device frame
    std::uint32_t buttons = 0;
    std::int64_t counter = 0;    ///< the driver's sample counter; a counter that stands still is stale input
    bool valid = false;          ///< false: the other members mean nothing
    bool taken = false;  ///< set by the engine: ticks were late and the watchdog faded the force; it must come in anew
    bool sound_lost = false;  ///< set by the engine once when a sound card is gone: the force fades and comes in anew
    std::array<FingerSample, most_fingers> fingers{};  ///< of a gripper
};
static_assert(std::is_trivially_destructible_v<DeviceSample>, "samples travel through rings");

/// What a device can do. Zero means none or unknown.
struct DeviceInfo {
    std::string name;
    double max_force = 0.0;  ///< N
    double max_torque = 0.0;  ///< N·m
    double damping = 0.0;  ///< N·s/m, of the mechanism and the hand on it; bounds the stiffness that is stable
    double max_stiffness = 0.0;  ///< N/m, as the maker states it
    double resolution = 0.0;  ///< m, step of the position that it reports
    double angular_resolution = 0.0;  ///< rad, step of the orientation
    double delay = 0.0;  ///< s, from a motion through the sample and the committed force to the force at the hand
    bool actuates_torque = false;
    bool senses_rotation = false;
    int fingers = 0;  ///< finger parts with a motor each; 0: no gripper
    double max_speed = 0.0;  ///< m/s of a finger
    double least_speed = 0.0;  ///< m/s; its motor turns no slower than this, or not at all
};

/// What the motors of a gripper, and the servo of a rig that holds it, are told for the next period.
struct MotorDrive {
    std::array<double, most_fingers> speed{};  ///< m/s, towards + the finger closes
    double cord = 0.0;  ///< m, where the rig's servo shall have the cord by the end of the period
    bool free = false;  ///< the low-friction mode, in which the hand moves the finger, where the motor has one
};

/// A haptic device. `acquire` and `commit` bracket the steps of the tick that belongs to it and are called by one
/// thread; a driver may block or call the system in them, since they stand outside the real-time scope.
class HapticDevice {
public:
    virtual ~HapticDevice() = default;

    virtual const DeviceInfo& info() const = 0;

    /// Sets the nominal tick period in s and goes to the initial state. May allocate. Throws Error.
    virtual void prepare(double period_s) = 0;

    /// Reads the device, once per activation and before the steps. `elapsed_s` is the logical time since the last call:
    /// one period, more after skipped ticks, 0 at the first call.
    virtual DeviceSample acquire(double elapsed_s) noexcept = 0;

    /// Sets the force on the hand, after the steps; it holds until the next call. Device frame, about the pose origin.
    /// When the tick's thread hangs, even inside `acquire`, another thread calls this to fade the force; two calls never
    /// run at the same time.
    virtual void commit(const Wrench& on_hand) noexcept = 0;

    /// Sets the speeds of a gripper's motors, after `commit`, from the thread of the tick only. They hold until the next
    /// call; when none comes, a device must stop by itself.
    virtual void drive(const MotorDrive&) noexcept {}
};

/// Counts of an audio output since `prepare`.
struct AudioStatistics {
    std::uint64_t frames_written = 0;  ///< accepted by `write`
    std::uint64_t frames_dropped = 0;  ///< refused by `write` because the buffer was full
    std::uint64_t frames_underflowed = 0;  ///< played as silence because nothing had been written
    std::uint64_t underflows = 0;  ///< times the card ran dry
    std::uint64_t frames_left_out = 0;  ///< accepted, but never played: too much had gathered
};

/// How far the card's clock has come: `frames` were asked for at `steady_ns` of std::chrono::steady_clock.
/// Frames 0 and time 0 mean that the card has not asked yet.
struct AudioProgress {
    std::int64_t frames = 0;
    std::int64_t steady_ns = 0;
    std::int64_t taken = 0;  ///< frames that left the buffer, played or left out
    std::int64_t largest = 0;  ///< most frames asked for at once
    bool waits = false;  ///< the card waits for the engine at the moment (JACK in freewheel) and keeps no time
};

/// An audio output.
class AudioSink {
public:
    virtual ~AudioSink() = default;

    virtual const std::string& name() const = 0;

    /// Opens the output with `rate` Hz and `channels` channels. May allocate and take long. Throws Error saying why the
    /// output cannot be had.
    virtual void prepare(double rate, int channels) = 0;

    /// Sends interleaved frames, nominally within ±1. Returns how many were accepted. Never waits for the card.
    virtual std::size_t write(const float* interleaved, std::size_t frames) noexcept = 0;

    /// Frames that `write` would accept now.
    virtual std::size_t writable() const noexcept = 0;

    virtual AudioStatistics statistics() const noexcept = 0;
    virtual AudioProgress progress() const noexcept = 0;

    /// So many frames are not to be played but thrown away, as soon as they are there. Any thread.
    virtual void leave_out(std::int64_t frames) noexcept = 0;

    /// Plays what is left, then releases the card. Called by the control thread only, never while another thread is
    /// inside `write`. Takes at most a few seconds, however dead the card is.
    virtual void close() = 0;
};

}  // namespace tactus
