// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/block.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <new>
#include <utility>

namespace tactus::hosted {

namespace {

void put(const Vec3& v, double (&into)[3]) noexcept {
    for (int i = 0; i < 3; ++i) into[i] = v[i];
}
Vec3 get(const double (&from)[3]) noexcept { return {from[0], from[1], from[2]}; }

void put(const Quat& q, double (&into)[4]) noexcept {
    into[0] = q.w;
    into[1] = q.x;
    into[2] = q.y;
    into[3] = q.z;
}
Quat get(const double (&from)[4]) noexcept { return {from[0], from[1], from[2], from[3]}; }

}  // namespace

SampleRecord pack(const DeviceSample& sample) noexcept {
    SampleRecord record;
    put(sample.pose.position, record.position);
    put(sample.pose.orientation, record.orientation);
    put(sample.twist.linear, record.linear);
    put(sample.twist.angular, record.angular);
    for (std::size_t i = 0; i < max_fingers; ++i) {
        record.finger_position[i] = sample.fingers[i].position;
        record.finger_force[i] = sample.fingers[i].force;
        record.finger_state[i] = sample.fingers[i].state;
    }
    record.counter = sample.counter;
    record.buttons = sample.buttons;
    record.is_valid = sample.valid ? 1 : 0;
    record.is_late = sample.late ? 1 : 0;
    return record;
}

DeviceSample unpack(const SampleRecord& record) noexcept {
    DeviceSample sample;
    sample.pose.position = get(record.position);
    sample.pose.orientation = get(record.orientation);
    sample.twist = {get(record.linear), get(record.angular)};
    for (std::size_t i = 0; i < max_fingers; ++i)
        sample.fingers[i] = {record.finger_position[i], record.finger_force[i], record.finger_state[i]};
    sample.counter = record.counter;
    sample.buttons = static_cast<std::uint32_t>(record.buttons);
    sample.late = record.is_late != 0;
    sample.valid = record.is_valid == 1 && is_good(sample.pose, sample.twist);
    return sample;
}

ForceRecord pack(const Wrench& wrench, std::int64_t now_ns) noexcept {
    ForceRecord record;
    put(wrench.force, record.force);
    put(wrench.torque, record.torque);
    record.committed_ns = now_ns;
    return record;
}

Wrench unpack(const ForceRecord& record) noexcept { return {get(record.force), get(record.torque)}; }

DriveRecord pack(const MotorDrive& drive, std::int64_t now_ns) noexcept {
    DriveRecord record;
    for (std::size_t i = 0; i < max_fingers; ++i) record.speed[i] = drive.speed[i];
    record.cord = drive.cord;
    record.is_free = drive.free ? 1 : 0;
    record.committed_ns = now_ns;
    return record;
}

MotorDrive unpack(const DriveRecord& record) noexcept {
    MotorDrive drive;
    for (std::size_t i = 0; i < max_fingers; ++i) drive.speed[i] = record.speed[i];
    drive.cord = record.cord;
    drive.free = record.is_free == 1;
    return drive;
}

PullRecord pack(const haptic::PulledHand& hand) noexcept {
    PullRecord record;
    put(hand.pose.position, record.position);
    put(hand.pose.orientation, record.orientation);
    put(hand.wanted.position, record.wanted_position);
    put(hand.wanted.orientation, record.wanted_orientation);
    put(hand.force.force, record.force);
    put(hand.force.torque, record.torque);
    record.at_ns = hand.at_ns;
    return record;
}

std::optional<haptic::PulledHand> unpack(const PullRecord& record) noexcept {
    const haptic::PulledHand hand{{get(record.position), get(record.orientation)},
                                  {get(record.wanted_position), get(record.wanted_orientation)},
                                  {get(record.force), get(record.torque)},
                                  record.at_ns};
    if (!is_valid(hand.pose) || !is_valid(hand.wanted) || !is_finite(hand.force)) return std::nullopt;
    return hand;
}

namespace {

/// A number that a driver states of its device, and its place in shared memory.
struct Number {
    double DeviceInfo::* stated;
    double InfoRecord::* shared;
};
constexpr std::array numbers{Number{&DeviceInfo::max_force, &InfoRecord::max_force},
                             Number{&DeviceInfo::max_torque, &InfoRecord::max_torque},
                             Number{&DeviceInfo::damping, &InfoRecord::damping},
                             Number{&DeviceInfo::max_stiffness, &InfoRecord::max_stiffness},
                             Number{&DeviceInfo::max_speed, &InfoRecord::max_speed},
                             Number{&DeviceInfo::least_speed, &InfoRecord::least_speed},
                             Number{&DeviceInfo::resolution, &InfoRecord::resolution},
                             Number{&DeviceInfo::angular_resolution, &InfoRecord::angular_resolution},
                             Number{&DeviceInfo::delay, &InfoRecord::delay}};

}  // namespace

InfoRecord pack(const DeviceInfo& info) noexcept {
    InfoRecord record;
    std::memcpy(record.name, info.name.data(), std::min(info.name.size(), sizeof record.name - 1));
    for (const Number& number : numbers) record.*number.shared = info.*number.stated;
    record.actuates_torque = info.actuates_torque ? 1 : 0;
    record.senses_rotation = info.senses_rotation ? 1 : 0;
    record.without_motors = info.without_motors ? 1 : 0;
    record.fingers = info.fingers;
    return record;
}

DeviceInfo unpack(const InfoRecord& record) {
    for (const Number& number : numbers)
        if (const double stated = record.*number.shared; !(std::isfinite(stated) && stated >= 0.0))
            throw Error(fmt::format("the driver states {} as a limit of its device", stated));
    if (record.fingers < 0 || record.fingers > static_cast<std::int64_t>(max_fingers))
        throw Error(fmt::format("the driver states {} fingers", record.fingers));
    DeviceInfo info;
    info.name = text_of(record.name, sizeof record.name);
    for (const Number& number : numbers) info.*number.stated = record.*number.shared;
    info.actuates_torque = record.actuates_torque == 1;
    info.senses_rotation = record.senses_rotation == 1;
    info.without_motors = record.without_motors == 1;
    info.fingers = static_cast<int>(record.fingers);
    return info;
}

std::string text_of(const char* text, std::size_t size) {
    std::string all(text, ::strnlen(text, size));
    for (char& c : all)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return all;
}

SharedBlock SharedBlock::create() {
    const int file = ::memfd_create("tactus-device", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    const auto fail = [&] {
        const int why = errno;
        if (file >= 0) ::close(file);
        throw Error(fmt::format("no memory to share with a device's process: {}", std::strerror(why)));
    };
    if (file < 0 || ::ftruncate(file, sizeof(Block)) != 0) fail();
    // So that nobody can take memory away that the other side reads.
    if (::fcntl(file, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) fail();
    void* const memory = ::mmap(nullptr, sizeof(Block), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file, 0);
    if (memory == MAP_FAILED) fail();
    Block* const block = new (memory) Block;
    block->engine = ::getpid();
    return {block, file};
}

SharedBlock SharedBlock::open(int descriptor) {
    struct stat file{};
    const bool is_right_size = ::fstat(descriptor, &file) == 0 && file.st_size == sizeof(Block);
    void* const memory =
        is_right_size ? ::mmap(nullptr, sizeof(Block), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, descriptor, 0)
                      : MAP_FAILED;
    ::close(descriptor);
    if (memory == MAP_FAILED)
        throw Error("the shared memory has another size; are engine and device host of one build?");
    Block* const block = static_cast<Block*>(memory);
    if (block->magic != Block::right_magic || block->version != Block::right_version || block->size != sizeof(Block)) {
        ::munmap(memory, sizeof(Block));
        throw Error("the shared memory has another layout; are engine and device host of one build?");
    }
    return {block, -1};
}

SharedBlock::SharedBlock(SharedBlock&& other) noexcept
    : block_(std::exchange(other.block_, nullptr)), descriptor_(std::exchange(other.descriptor_, -1)) {}

SharedBlock::~SharedBlock() {
    close_descriptor();
    if (block_) ::munmap(block_, sizeof(Block));
}

void SharedBlock::close_descriptor() noexcept {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

}  // namespace tactus::hosted
