// SPDX-License-Identifier: Apache-2.0
// The memory common to an engine and a device's process: samples in one direction, forces and motor speeds in the
// other. Each side validates its input, because the other may be faulty.
#pragma once

#include "devices/haptic/pulled_hand.hpp"
#include "devices/hosted/seqlock.hpp"
#include "graph/node/device.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace tactus::hosted {

/// The newest sample of the device. Published at the rate of the device's process.
struct SampleRecord {
    double position[3] = {}, orientation[4] = {1.0, 0.0, 0.0, 0.0};  ///< m; w, x, y, z
    double linear[3] = {}, angular[3] = {};  ///< m/s, rad/s
    double finger_position[max_fingers] = {}, finger_force[max_fingers] = {};  ///< m, N
    std::uint64_t finger_state[max_fingers] = {};
    std::int64_t counter = 0;
    std::uint64_t buttons = 0;
    std::uint64_t is_valid = 0, is_late = 0;
    std::uint64_t holds_force = 0;  ///< the process gives no force until it receives a small one
    std::int64_t answers_ns = 0;  ///< `committed_ns` of the force that was active at this sample
    std::int64_t published_ns = 0;  ///< boot_ns: the heartbeat of the device's process
};

/// The newest force from the engine.
struct ForceRecord {
    double force[3] = {}, torque[3] = {};  ///< N, N·m on the hand
    std::int64_t committed_ns = 0;  ///< boot_ns: the heartbeat of the engine; 0: none yet
};

struct DriveRecord {
    double speed[max_fingers] = {};  ///< m/s
    double cord = 0.0;  ///< m
    std::uint64_t is_free = 0;
    std::int64_t committed_ns = 0;
};

/// Target pose of the hand, for drivers that pull it there by a spring.
struct PullRecord {
    double position[3] = {}, orientation[4] = {1.0, 0.0, 0.0, 0.0};  ///< of the hand: m; w, x, y, z
    double wanted_position[3] = {}, wanted_orientation[4] = {1.0, 0.0, 0.0, 0.0};
    double force[3] = {}, torque[3] = {};  ///< N, N·m on the hand
    std::int64_t at_ns = 0;  ///< steady_ns
};

struct InfoRecord {
    char name[128] = {};
    double max_force = 0.0, max_torque = 0.0, damping = 0.0, max_stiffness = 0.0, max_speed = 0.0, least_speed = 0.0;
    double resolution = 0.0, angular_resolution = 0.0, delay = 0.0;
    std::uint64_t actuates_torque = 0, senses_rotation = 0, without_motors = 0;
    std::int64_t fingers = 0;
};

SampleRecord pack(const DeviceSample& sample) noexcept;
ForceRecord pack(const Wrench& wrench, std::int64_t now_ns) noexcept;
DriveRecord pack(const MotorDrive& drive, std::int64_t now_ns) noexcept;
InfoRecord pack(const DeviceInfo& info) noexcept;
PullRecord pack(const haptic::PulledHand& hand) noexcept;
/// Returns an invalid sample if the pose is invalid or the velocity is not finite.
DeviceSample unpack(const SampleRecord& record) noexcept;
Wrench unpack(const ForceRecord& record) noexcept;
MotorDrive unpack(const DriveRecord& record) noexcept;
/// Returns nothing if a pose is invalid or the force is not finite.
std::optional<haptic::PulledHand> unpack(const PullRecord& record) noexcept;
/// Throws Error if a number is not plausible for a device.
DeviceInfo unpack(const InfoRecord& record);

enum class HostState : std::uint32_t { opens, runs, ended };

struct Block {
    static constexpr std::uint64_t right_magic = 0x3153554843544154;  // "TATCHUS1"
    static constexpr std::uint32_t right_version = 5;

    std::uint64_t magic = right_magic;
    std::uint32_t version = right_version, size = sizeof(Block);
    std::int64_t engine = 0;  ///< process id
    std::atomic<HostState> state{HostState::opens};
    std::atomic<std::uint32_t> must_end{0};  ///< set by the engine
    std::atomic<std::int64_t> engine_lives_ns{0};  ///< steady_ns of the engine's control thread; 0: not yet set
    char reason[256] = {};  ///< reason of the process's end, for messages; complete when `state` is ended
    InfoRecord info;  ///< complete when the process has reported that it is ready
    alignas(64) Seqlock<SampleRecord> sample;
    alignas(64) Seqlock<ForceRecord> force;
    alignas(64) Seqlock<DriveRecord> drive;
    alignas(64) Seqlock<PullRecord> pull;
};

/// Copies text from memory that another process writes: stops at its size, and keeps only printable characters.
std::string text_of(const char* text, std::size_t size);

/// The block, mapped into this process.
class SharedBlock {
public:
    /// Creates a block in anonymous memory. Throws Error.
    static SharedBlock create();
    /// Maps the block of an inherited descriptor and closes the descriptor. Throws Error if it is not a valid block.
    static SharedBlock open(int descriptor);

    SharedBlock(SharedBlock&& other) noexcept;
    SharedBlock& operator=(SharedBlock&&) = delete;
    ~SharedBlock();

    Block* operator->() const noexcept { return block_; }
    Block& operator*() const noexcept { return *block_; }
    int descriptor() const noexcept { return descriptor_; }
    /// Closes the descriptor; the memory stays mapped.
    void close_descriptor() noexcept;

private:
    SharedBlock(Block* block, int descriptor) : block_(block), descriptor_(descriptor) {}

    Block* block_ = nullptr;
    int descriptor_ = -1;
};

}  // namespace tactus::hosted
