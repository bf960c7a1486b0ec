// SPDX-License-Identifier: Apache-2.0
// The 3D mouse, with a daemon that a test plays. Where Debian's libspnav is installed it hears the same daemon.
#include "devices/spacenav/space_mouse.hpp"

#include "devices/spacenav/events.hpp"
#include "dsp/core/clock.hpp"
#include "tests/devices/driver/peer.hpp"
#include "tests/devices/driver/space_daemon.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cmath>
#include <cstring>
#include <thread>

using namespace tactus;
using namespace tactus::test;

namespace {

std::unique_ptr<driver::ThreadedDevice> open(SpaceDaemon& daemon) {
    Options options = options_of({{"socket", daemon.path, {}}, {"speed", "100 mm/s", {}}});
    driver::DeviceOptions how{.driver = "space_mouse"};
    how.reopen_every = std::chrono::milliseconds(20);
    auto device = std::make_unique<driver::ThreadedDevice>(spacenav::make_space_mouse(options), how);
    daemon.accept();
    device->prepare(1e-3);
    return device;
}

/// Ticks for that long; the last sample.
DeviceSample ticks(HapticDevice& device, int count, const Vec3& force = Vec3(0.0)) {
    DeviceSample sample;
    for (int i = 0; i < count; ++i) {
        device.commit({force, {}});
        sample = device.acquire(1e-3);
        sleep_until(steady_ns() + ms);
    }
    return sample;
}

}  // namespace

TEST_CASE("events of spacenavd are put together from any pieces") {
    spacenav::EventReader reader;
    const Event moved = motion(10, -20, 30, 400, -9000, 6);
    const Event pressed{1, 3, 0, 0, 0, 0, 0, 0}, other{17, 1, 1, 1, 1, 1, 1, 1};
    std::array<std::uint8_t, 3 * sizeof(Event)> all;
    std::memcpy(all.data(), moved.data(), sizeof moved);
    std::memcpy(all.data() + sizeof(Event), other.data(), sizeof other);
    std::memcpy(all.data() + 2 * sizeof(Event), pressed.data(), sizeof pressed);
    for (std::size_t i = 0; i < all.size(); i += 5)
        reader.take({all.data() + i, std::min<std::size_t>(5, all.size() - i)});
    CHECK(reader.state().deflection == std::array<int, 6>{10, -20, 30, 400, -500, 6});
    CHECK(reader.state().buttons == 8u);
    CHECK(reader.state().events == 2);
}

TEST_CASE("a cap that nothing is heard of, or whose device came or went, deflects no longer") {
    using spacenav::EventReader;
    const auto tell = [](EventReader& reader, const Event& event) {
        reader.take({reinterpret_cast<const std::uint8_t*>(event.data()), sizeof event});
    };
    const std::array<int, 6> none{}, full{350, 0, 0, 0, 0, -350};
    EventReader reader;
    // The answer to the question for devices is no part of an event, wherever it comes.
    const std::int32_t answer = spacenav::ask_for_devices;
    reader.take({reinterpret_cast<const std::uint8_t*>(&answer), sizeof answer});
    tell(reader, motion(350, 0, 0, 0, 0, -350));
    reader.take({reinterpret_cast<const std::uint8_t*>(&answer), sizeof answer});
    tell(reader, {1, 2, 0, 0, 0, 0, 0, 0});
    CHECK(reader.state().deflection == full);
    reader.pass(EventReader::longest_silence_ns - 1);
    CHECK(reader.state().deflection == full);
    tell(reader, motion(350, 0, 0, 0, 0, -350));  // as the daemon repeats it
    reader.pass(EventReader::longest_silence_ns - 1);
    CHECK(reader.state().deflection == full);
    reader.pass(1);
    CHECK(reader.state().deflection == none);
    CHECK(reader.state().buttons == 4u);
    tell(reader, motion(350, 0, 0, 0, 0, -350));
    reader.pass(1);
    CHECK(reader.state().deflection == full);
    tell(reader, {3, 1, 0, 0x206, 0x46d, 0xc626, 0, 0});  // removed
    CHECK(reader.state().deflection == none);
    CHECK(reader.state().buttons == 0u);
}

TEST_CASE("a 3D mouse that is pulled out while its cap is deflected stops the hand", "[live]") {
    SpaceDaemon daemon;
    const auto device = open(daemon);
    REQUIRE(wait_until([&] { return device->acquire(1e-3).valid; }));
    std::int32_t asked = 0;
    REQUIRE(::recv(daemon.client(), &asked, sizeof asked, 0) == sizeof asked);
    CHECK(asked == spacenav::ask_for_devices);
    const auto speed_up = [&] { return device->acquire(1e-3).twist.linear.z; };
    for (const bool is_told : {true, false}) {
        CAPTURE(is_told);
        daemon.send(motion(0, 350, 0, 0, 0, 0));
        REQUIRE(wait_until([&] { return speed_up() > 0.08; }));
        if (is_told) daemon.send({3, 1, 0, 0x206, 0x46d, 0xc626, 0, 0});
        CHECK(wait_until([&] { return std::abs(speed_up()) < 0.01; }, is_told ? 700 : 2500));
        // Not because the hand is at the end of its reach.
        CHECK(device->acquire(1e-3).pose.position.z < 0.149);
        REQUIRE(wait_until([&] {
            // Again and again, as of a cap that is held: it would be let go after a second.
            daemon.send(motion(0, -350, 0, 0, 0, 0));
            return device->acquire(1e-3).pose.position.z < 0.0;
        }));
    }
}

TEST_CASE("the cap steers the hand: right, up, and away from the user, turns with the right sign", "[kernel]") {
    SpaceDaemon daemon;
    const auto device = open(daemon);
    REQUIRE(wait_until([&] { return device->acquire(1e-3).valid; }));
    CHECK_FALSE(device->is_capped());
    const struct {
        Event event;
        Vec3 way, turn;
    } cases[] = {{motion(350, 0, 0, 0, 0, 0), {1, 0, 0}, {}},  {motion(0, 350, 0, 0, 0, 0), {0, 0, 1}, {}},
                 {motion(0, 0, 350, 0, 0, 0), {0, 1, 0}, {}},  {motion(0, 0, 0, 350, 0, 0), {}, {-1, 0, 0}},
                 {motion(0, 0, 0, 0, 350, 0), {}, {0, 0, -1}}, {motion(0, 0, 0, 0, 0, 350), {}, {0, -1, 0}}};
    for (const auto& one : cases) {
        daemon.send(one.event);
        const DeviceSample moving = ticks(*device, 150);
        CAPTURE(one.event[1], one.event[2], one.event[3]);
        CHECK(glm::length(moving.twist.linear - 0.1 * one.way) < 0.02);
        CHECK(glm::length(moving.twist.angular - one.turn) < 0.2);
        daemon.send(motion(0, 0, 0, 0, 0, 0));
        CHECK(glm::length(ticks(*device, 150).twist.linear) < 0.01);
    }
    daemon.send({1, 0, 0, 0, 0, 0, 0, 0});
    daemon.send({1, 1, 0, 0, 0, 0, 0, 0});
    CHECK(wait_until([&] { return device->acquire(1e-3).buttons == (1u | 4u); }));
    daemon.send({2, 0, 0, 0, 0, 0, 0, 0});
    CHECK(wait_until([&] { return device->acquire(1e-3).buttons == 4u; }));
    const double before = ticks(*device, 20).pose.position.z;
    // 2 N/mm. A tick of this test that is late lets the force fade, as it should: so until it has held long enough.
    device->prepare(20e-3);
    CHECK(wait_until([&] {
        device->commit({{0.0, 0.0, 4.0}, {}});
        return std::abs(device->acquire(1e-3).pose.position.z - before - 2e-3) < 2e-5;
    }));
}

TEST_CASE("a hand that a 3D mouse has led to the end of its reach is there to a micrometre, and lost with the daemon",
          "[kernel]") {
    SpaceDaemon daemon;
    Options options = options_of({{"socket", daemon.path, {}}, {"speed", "1 m/s", {}}, {"reach", "20 mm", {}}});
    driver::ThreadedDevice device(spacenav::make_space_mouse(options), {.driver = "space_mouse"});
    daemon.accept();
    device.prepare(1e-3);
    for (const Vec3& corner : {Vec3(0.02, 0.02, -0.02), Vec3(-0.02, 0.02, 0.02)}) {
        const auto full = [](double x) { return x > 0.0 ? 350 : -350; };
        CHECK(wait_until([&] {
            device.commit({});
            daemon.send(motion(full(corner.x), full(corner.z), full(corner.y), 0, 0, 0));
            const DeviceSample sample = device.acquire(1e-3);
            return sample.valid && glm::length(sample.pose.position - corner) < 1e-6;
        }));
    }
    daemon.leave();
    CHECK(wait_until([&] { return !device.acquire(1e-3).valid; }, 1000));
}

TEST_CASE("a daemon that is gone, floods or sends pieces neither delays nor moves the hand by itself", "[live]") {
    SpaceDaemon daemon;
    const auto device = open(daemon);
    REQUIRE(wait_until([&] { return device->acquire(1e-3).valid; }));
    ::fcntl(daemon.client(), F_SETFL, O_NONBLOCK);
    const Event nothing = motion(0, 0, 0, 0, 0, 0);
    for (int i = 0; i < 3000; ++i) daemon.send(nothing);
    CHECK(ticks(*device, 50).valid);
    daemon.send_bytes(nothing.data(), 7);
    CHECK(ticks(*device, 50).valid);
    daemon.leave();
    CHECK(wait_until([&] { return !device->acquire(1e-3).valid; }, 100));
    daemon.listen();
    daemon.accept();
    CHECK(wait_until([&] { return device->acquire(1e-3).valid; }, 1000));
}

TEST_CASE("Debian's libspnav hears from the daemon what the driver hears", "[kernel]") {
    void* const library = ::dlopen("libspnav.so.0", RTLD_NOW | RTLD_LOCAL);
    if (!library) return skip("libspnav is not installed");
    SpaceDaemon daemon;
    ::setenv("SPNAV_SOCKET", daemon.path.c_str(), 1);
    std::thread answer([&] {
        daemon.accept();
        // It asks for a newer protocol first; a daemon that knows it says the same.
        pollfd one{daemon.client(), POLLIN, 0};
        std::int32_t asked = 0;
        if (::poll(&one, 1, 1000) > 0 && ::recv(daemon.client(), &asked, sizeof asked, 0) == sizeof asked)
            daemon.send_bytes(&asked, sizeof asked);
    });
    const auto open_it = reinterpret_cast<int (*)()>(::dlsym(library, "spnav_open"));
    const auto close_it = reinterpret_cast<int (*)()>(::dlsym(library, "spnav_close"));
    struct Heard {
        int type, x, y, z, rx, ry, rz;
        unsigned period;
        int* data;
        int room[8];
    };
    const auto wait = reinterpret_cast<int (*)(Heard*)>(::dlsym(library, "spnav_wait_event"));
    REQUIRE(open_it() == 0);
    answer.join();
    const Event event = motion(11, -22, 33, -44, 55, -66);
    daemon.send(event);
    Heard heard{};
    CHECK(wait(&heard) == 1);
    spacenav::EventReader reader;
    reader.take({reinterpret_cast<const std::uint8_t*>(event.data()), sizeof event});
    CHECK(std::array<int, 6>{heard.x, heard.y, heard.z, heard.rx, heard.ry, heard.rz} == reader.state().deflection);
    daemon.send({1, 2, 0, 0, 0, 0, 0, 0});
    CHECK(wait(&heard) == 2);
    CHECK(heard.x == 1);  // pressed
    CHECK(heard.y == 2);  // button
    close_it();
    ::unsetenv("SPNAV_SOCKET");
}

TEST_CASE("a 3D mouse tells where its cap wants the hand and what the hand feels", "[live]") {
    SpaceDaemon daemon;
    const auto device = open(daemon);
    REQUIRE(wait_until([&] { return device->acquire(1e-3).valid; }));
    daemon.send(motion(350, 0, 0, 0, 0, 0));
    ticks(*device, 20);  // forces begin with none
    haptic::PulledHand told;
    std::uint64_t number = 0;
    CHECK(wait_until([&] {
        ticks(*device, 1, {-4.0, 0.0, 0.0});
        return device->pull()->read(told, number) && number != 0 && told.force.force.x == -4.0 &&
               told.wanted.position.x - told.pose.position.x > 0.001;
    }));
}
