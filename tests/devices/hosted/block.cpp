// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/block.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>
#include <vector>

using namespace tactus;
using namespace tactus::hosted;

namespace {

/// Shared memory with these bytes.
int memory_of(const std::vector<char>& bytes) {
    const int file = ::memfd_create("tactus-test", MFD_CLOEXEC);
    REQUIRE(::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
    return file;
}

std::vector<char> good_block() {
    const SharedBlock block = SharedBlock::create();
    std::vector<char> bytes(sizeof(Block));
    std::memcpy(bytes.data(), &*block, sizeof(Block));
    return bytes;
}

}  // namespace

TEST_CASE("shared memory of another size or layout is refused") {
    const std::vector<char> good = good_block();
    CHECK_NOTHROW(SharedBlock::open(memory_of(good)));
    std::vector<char> longer = good, shorter = good, other_magic = good, other_version = good, other_size = good;
    longer.push_back(0);
    shorter.pop_back();
    other_magic[0] ^= 1;
    other_version[8] ^= 1;
    other_size[12] ^= 1;
    for (const auto& bytes : {longer, shorter, other_magic, other_version, other_size, std::vector<char>{}})
        CHECK_THROWS_AS(SharedBlock::open(memory_of(bytes)), Error);
    CHECK_THROWS_AS(SharedBlock::open(-1), Error);
}

TEST_CASE("nobody can take shared memory away that another process reads") {
    const SharedBlock block = SharedBlock::create();
    CHECK(::ftruncate(block.descriptor(), 0) != 0);
    CHECK((::fcntl(block.descriptor(), F_GETFD) & FD_CLOEXEC) != 0);
}

TEST_CASE("a value is read whole or not at all, while another thread writes") {
    struct Pair {
        std::int64_t a[16] = {};
    };
    Seqlock<Pair> lock;
    std::atomic<bool> over{false};
    std::thread writer([&] {
        Pair pair;
        for (std::int64_t n = 1; n <= 200'000; ++n) {
            for (std::int64_t& a : pair.a) a = n;
            lock.write(pair);
        }
        over = true;
    });
    std::int64_t torn = 0, backwards = 0, last = 0;
    std::uint64_t number = 0;
    while (!over) {
        Pair seen;
        if (!lock.read(seen, number)) continue;
        for (const std::int64_t a : seen.a) torn += a != seen.a[0];
        backwards += seen.a[0] < last;
        last = seen.a[0];
    }
    writer.join();
    CHECK(torn == 0);
    CHECK(backwards == 0);
    Pair seen;
    REQUIRE(lock.read(seen, number));
    CHECK(seen.a[15] == 200'000);
}

TEST_CASE("a writer that was killed inside a value is read as nothing new, and another may go on") {
    struct Word {
        std::uint64_t value = 0;
    };
    Seqlock<Word> lock;
    lock.write({7});
    reinterpret_cast<std::uint64_t*>(&lock)[0] = 3;
    Word seen{7};
    std::uint64_t number = 2;
    CHECK_FALSE(lock.read(seen, number));
    CHECK(seen.value == 7);
    CHECK(number == 2);
    lock.write({8});
    REQUIRE(lock.read(seen, number));
    CHECK(seen.value == 8);
    CHECK(number != 2);
}

TEST_CASE("what cannot be a device or a pose is refused") {
    DeviceInfo info;
    info.name = std::string(300, 'x');
    info.fingers = 2;
    CHECK(unpack(pack(info)).name.size() == 127);
    InfoRecord record = pack(info);
    record.max_force = std::nan("");
    CHECK_THROWS_AS(unpack(record), Error);
    record = pack(info);
    record.damping = -1.0;
    CHECK_THROWS_AS(unpack(record), Error);
    record = pack(info);
    record.fingers = 3;
    CHECK_THROWS_AS(unpack(record), Error);

    DeviceSample sample;
    sample.valid = true;
    CHECK(unpack(pack(sample)).valid);
    sample.pose.orientation.w = 0.0;
    CHECK_FALSE(unpack(pack(sample)).valid);
    sample = {};
    sample.valid = true;
    sample.twist.angular.y = std::nan("");
    CHECK_FALSE(unpack(pack(sample)).valid);
    SampleRecord garbage;
    std::memset(static_cast<void*>(&garbage), 0xFF, sizeof garbage);
    CHECK_FALSE(unpack(garbage).valid);
}

TEST_CASE("what a driver states of its device is the same on both sides") {
    const DeviceInfo info{.name = "arm",
                          .max_force = 1.0,
                          .max_torque = 2.0,
                          .damping = 3.0,
                          .max_stiffness = 4.0,
                          .resolution = 5.0,
                          .angular_resolution = 6.0,
                          .delay = 7.0,
                          .actuates_torque = true,
                          .senses_rotation = true,
                          .without_motors = true,
                          .fingers = 1,
                          .max_speed = 8.0,
                          .least_speed = 9.0};
    const DeviceInfo seen = unpack(pack(info));
    CHECK(seen.name == info.name);
    CHECK(seen.max_force == info.max_force);
    CHECK(seen.max_torque == info.max_torque);
    CHECK(seen.damping == info.damping);
    CHECK(seen.max_stiffness == info.max_stiffness);
    CHECK(seen.resolution == info.resolution);
    CHECK(seen.angular_resolution == info.angular_resolution);
    CHECK(seen.delay == info.delay);
    CHECK(seen.actuates_torque);
    CHECK(seen.senses_rotation);
    CHECK(seen.without_motors);
    CHECK(seen.fingers == info.fingers);
    CHECK(seen.max_speed == info.max_speed);
    CHECK(seen.least_speed == info.least_speed);

    InfoRecord record = pack(info);
    record.delay = -1.0;
    CHECK_THROWS_AS(unpack(record), Error);
}

TEST_CASE("a sample is the same on both sides") {
    DeviceSample sample;
    sample.pose = {{1.0, 2.0, 3.0}, {0.5, 0.5, -0.5, 0.5}};
    sample.twist = {{4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}};
    sample.buttons = 5;
    sample.counter = 12;
    sample.late = true;
    sample.valid = true;
    sample.fingers[1] = {0.1, 0.2, motor_limited};
    const DeviceSample seen = unpack(pack(sample));
    CHECK(seen.pose.position == sample.pose.position);
    CHECK(seen.pose.orientation == sample.pose.orientation);
    CHECK(seen.twist.linear == sample.twist.linear);
    CHECK(seen.twist.angular == sample.twist.angular);
    CHECK(seen.buttons == 5);
    CHECK(seen.counter == 12);
    CHECK(seen.valid);
    CHECK(seen.late);
    CHECK_FALSE(unpack(pack(DeviceSample{})).late);
    CHECK(seen.fingers[1].position == 0.1);
    CHECK(seen.fingers[1].force == 0.2);
    CHECK(seen.fingers[1].state == motor_limited);
}

TEST_CASE("where a hand is wanted comes through shared memory whole, and is none when it is no pose or no force") {
    const haptic::PulledHand hand{{Vec3(1.0, 2.0, 3.0), Quat(0.0, 1.0, 0.0, 0.0)},
                                  {Vec3(4.0, 5.0, 6.0), Quat(0.0, 0.0, 1.0, 0.0)},
                                  {Vec3(7.0, 8.0, 9.0), Vec3(10.0, 11.0, 12.0)},
                                  13};
    const PullRecord record = pack(hand);
    const auto told = unpack(record);
    REQUIRE(told);
    CHECK(told->pose.position == hand.pose.position);
    CHECK(told->pose.orientation == hand.pose.orientation);
    CHECK(told->wanted.position == hand.wanted.position);
    CHECK(told->wanted.orientation == hand.wanted.orientation);
    CHECK(told->force.force == hand.force.force);
    CHECK(told->force.torque == hand.force.torque);
    CHECK(told->at_ns == 13);
    PullRecord lost = record, shapeless = record, endless = record;
    lost.wanted_position[1] = std::nan("");
    for (double& part : shapeless.orientation) part = 0.0;
    endless.force[2] = INFINITY;
    for (const PullRecord& broken : {lost, shapeless, endless}) CHECK_FALSE(unpack(broken));
}
