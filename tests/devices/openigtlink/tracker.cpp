// SPDX-License-Identifier: Apache-2.0
// The driver with a tracker's server that a test plays.
#include "devices/openigtlink/tracker.hpp"
#include "devices/openigtlink/message.hpp"
#include "dsp/core/clock.hpp"
#include "tests/devices/driver/peer.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <cmath>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr std::int64_t one_ms = 1'000'000;

class TrackerServer {
public:
    TrackerServer() { listen(0); }
    ~TrackerServer() { leave(); }
    void listen(int wanted) {
        listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const int again = 1;
        ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &again, sizeof again);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(static_cast<std::uint16_t>(wanted));
        REQUIRE(::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
        socklen_t size = sizeof address;
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
        port = ntohs(address.sin_port);
        ::listen(listener_, 4);
    }
    void leave() {
        if (client_ >= 0) ::close(client_);
        if (listener_ >= 0) ::close(listener_);
        client_ = listener_ = -1;
    }
    void accept() {
        client_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        ::fcntl(client_, F_SETFL, O_NONBLOCK);
    }
    void send(const std::vector<std::uint8_t>& bytes) {
        [[maybe_unused]] const auto sent = ::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    }
    int port = 0;

private:
    int listener_ = -1, client_ = -1;
};

std::unique_ptr<driver::ThreadedDevice> open(TrackerServer& server) {
    Options options = options_of({{"port", std::to_string(server.port), {}}, {"transform", "Stylus", {}}});
    driver::DeviceOptions how{.driver = "openigtlink"};
    how.reopen_every = std::chrono::milliseconds(20);
    auto device = std::make_unique<driver::ThreadedDevice>(openigtlink::make_tracker(options), how);
    server.accept();
    device->prepare(1e-3);
    return device;
}

Pose at(double x) {
    Pose pose;
    pose.position = {x, -0.02, 0.3};
    return pose;
}

}  // namespace

TEST_CASE("between two poses of a tracker the hand moves evenly, turns the short way, and stands when none comes") {
    openigtlink::Interpolation motion;
    Pose pose;
    Twist twist;
    CHECK_FALSE(motion.at(0, 100 * one_ms, pose, twist));
    motion.add(at(0.0), 0);
    REQUIRE(motion.at(0, 100 * one_ms, pose, twist));
    CHECK(twist.linear == Vec3(0.0));
    // 40 poses a second of a tool at 0.2 m/s that turns by 2 rad/s; each second quaternion has the other sign.
    for (int i = 1; i < 40; ++i) {
        Pose next = at(0.005 * i);
        next.orientation = Quat(std::cos(0.025 * i), 0.0, 0.0, std::sin(0.025 * i));
        if (i % 2 != 0) next.orientation = -next.orientation;
        motion.add(next, 25 * one_ms * i);
        for (int k = 1; k < 25; ++k) {
            REQUIRE(motion.at(one_ms * (25 * i + k), 100 * one_ms, pose, twist));
            CHECK(pose.position.x == Approx(0.005 * (i - 1) + 0.0002 * k).margin(1e-12));
            CHECK(twist.linear.x == Approx(0.2));
            CHECK(twist.angular.z == Approx(2.0));
        }
    }
    REQUIRE(motion.at(one_ms * (25 * 39 + 60), 100 * one_ms, pose, twist));
    CHECK(pose.position.x == Approx(0.195));
    CHECK(twist.linear == Vec3(0.0));
    CHECK_FALSE(motion.at(one_ms * (25 * 39 + 101), 100 * one_ms, pose, twist));
}

TEST_CASE("a pose that comes early does not make the hand jump") {
    openigtlink::Interpolation motion;
    motion.add(at(0.0), 0);
    motion.add(at(0.01), 20 * one_ms);
    motion.add(at(0.02), 25 * one_ms);
    Pose before, after;
    Twist twist;
    motion.at(25 * one_ms, 100 * one_ms, after, twist);
    CHECK(after.position.x == Approx(0.0025));
    openigtlink::Interpolation same;
    same.add(at(0.0), 0);
    same.add(at(0.01), 20 * one_ms);
    same.at(25 * one_ms, 100 * one_ms, before, twist);
    CHECK(before.position.x == Approx(after.position.x));
}

TEST_CASE("a tool of a tracker is a hand: valid while it is seen, lost and found with its server", "[kernel]") {
    TrackerServer server;
    const auto device = open(server);
    const auto samples_until = [&](bool valid, int longest_ms, bool sends = false) {
        for (int i = 0; i < longest_ms; ++i) {
            if (sends && i % 16 == 0) {
                server.send(openigtlink::transform_message("Other", at(5.0), 0.0));
                server.send(openigtlink::transform_message("Stylus", at(0.1), 0.0));
            }
            const DeviceSample sample = device->acquire(1e-3);
            if (sample.valid == valid) return true;
            device->commit({});
            sleep_until(steady_ns() + one_ms);
        }
        return false;
    };
    CHECK_FALSE(device->acquire(1e-3).valid);
    REQUIRE(samples_until(true, 4000, true));
    CHECK(glm::length(device->acquire(1e-3).pose.position - Vec3(0.1, -0.02, 0.3)) < 1e-6);
    CHECK_FALSE(device->is_capped());
    // Silence of the server, then its end, then another one.
    CHECK(samples_until(false, 4000));
    server.leave();
    server.listen(server.port);
    server.accept();
    CHECK(samples_until(true, 4000, true));
    // A flood and what is no message: the peer is left, and taken again.
    const std::vector<std::uint8_t> flood(1 << 20, 0x41);
    server.send(flood);
    CHECK(samples_until(false, 4000));
    server.accept();
    CHECK(samples_until(true, 4000, true));
}

TEST_CASE("a host that is none, and a port where nobody answers, are named") {
    const auto opened = [](const std::string& host, const std::string& port) {
        Options options = options_of({{"host", host, {}}, {"port", port, {}}});
        driver::ThreadedDevice device(openigtlink::make_tracker(options), {.driver = "openigtlink"});
    };
    CHECK_THROWS_WITH(opened("127.0.0.1", "1"),
                      Catch::Matchers::ContainsSubstring("no answer at 127.0.0.1:1") &&
                          Catch::Matchers::ContainsSubstring("is its OpenIGTLink server on?"));
    CHECK_THROWS_WITH(opened("no.such.host.invalid", "1"),
                      Catch::Matchers::ContainsSubstring("no host 'no.such.host.invalid'"));
    CHECK_THROWS_WITH(opened("127.0.0.1", "1.5"), Catch::Matchers::ContainsSubstring("'port' is a whole number"));
}
