// SPDX-License-Identifier: Apache-2.0
// What every driver of a device that pushes promises, with a stand-in at the other side.
#include "dsp/core/clock.hpp"
#include "tests/devices/driver/peer.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"
#include "tests/support/virtual_clock.hpp"

#include <cmath>
#include <limits>
#include <numbers>

using namespace tactus;
using namespace tactus::test;

namespace {

/// Ticks as an engine does, a millisecond each, until the condition holds; true when it did within 4 s.
bool tick_until(HapticDevice& device, const Wrench& force, const std::function<bool(const DeviceSample&)>& until) {
    std::int64_t next = steady_ns();
    for (int i = 0; i < 4000; ++i) {
        const DeviceSample sample = device.acquire(1e-3);
        if (until(sample)) return true;
        // As an engine: no force on a hand that nobody sees, also after a test that was late itself.
        device.commit(i < 10 || !sample.valid ? Wrench{} : force);
        sleep_until(next += ms);
    }
    return false;
}

double apart(const Vec3& a, const Vec3& b) { return glm::length(a - b); }

/// 0 when both are the same rotation.
double turned_apart(const Quat& a, const Quat& b) {
    return std::min(glm::length(Vec3(a.x - b.x, a.y - b.y, a.z - b.z)) + std::abs(a.w - b.w),
                    glm::length(Vec3(a.x + b.x, a.y + b.y, a.z + b.z)) + std::abs(a.w + b.w));
}

/// In reach of every peer.
Vec3 reachable(const Peer& peer, const Vec3& wanted) {
    return {wanted.x, peer.moves_along > 1 ? wanted.y : 0.0, peer.moves_along > 2 ? wanted.z : 0.0};
}

void check_units(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.04}), Quat(1.0, 0.0, 0.0, 0.0));
    const auto device = open_peer(*peer);
    for (const Vec3& wanted : {Vec3(0.0125, -0.101, 0.05), Vec3(-0.02, -0.09, 0.0125), Vec3(0.0, -0.11, -0.01)}) {
        const Vec3 at = reachable(*peer, wanted);
        const double half = 0.5 * std::numbers::pi / 6.0;
        const Quat turn =
            peer->turns ? Quat(std::cos(half), std::sin(half) * glm::normalize(wanted)) : Quat(1, 0, 0, 0);
        peer->place(at, turn);
        CHECK(tick_until(*device, {}, [&](const DeviceSample& sample) {
            return sample.valid && apart(sample.pose.position, at) <= peer->exact &&
                   turned_apart(sample.pose.orientation, turn) < 1e-6;
        }));
        CAPTURE(device->acquire(1e-3).pose.position.x, device->acquire(1e-3).pose.position.y);
    }
}

void check_forces(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.0}), Quat(1.0, 0.0, 0.0, 0.0));
    const auto device = open_peer(*peer);
    for (int axis = 0; axis < peer->moves_along; ++axis)
        for (const double newton : {0.75, -0.5}) {
            Wrench wanted;
            wanted.force[axis] = newton;
            CAPTURE(axis, newton);
            CHECK(tick_until(*device, wanted, [&](const DeviceSample&) {
                return apart(peer->given().force, wanted.force) <= peer->exact_force;
            }));
        }
    if (!peer->twists) return;
    CHECK(device->info().actuates_torque);
    for (int axis = 0; axis < 3; ++axis) {
        Wrench wanted;
        wanted.torque[axis] = 0.03;
        CHECK(tick_until(*device, wanted,
                         [&](const DeviceSample&) { return apart(peer->given().torque, wanted.torque) < 1e-12; }));
    }
}

void check_limits(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.0}), Quat(1.0, 0.0, 0.0, 0.0));
    const auto device = open_peer(*peer);
    const double most = device->info().max_force;
    CHECK(most > 0.5);
    CHECK(tick_until(*device, {{500.0, 0.0, 0.0}, {}},
                     [&](const DeviceSample&) { return std::abs(peer->given().force.x - most) <= 1e-3; }));
    CHECK(tick_until(*device, {{std::nan(""), 0.0, 0.0}, {}},
                     [&](const DeviceSample&) { return peer->given().force == Vec3(0.0); }));
    for (int i = 0; i < 20; ++i) {
        device->commit({{std::numeric_limits<double>::infinity(), 0.0, 0.0}, {}});
        CHECK(glm::length(peer->given().force) == 0.0);
        sleep_until(steady_ns() + ms);
    }
}

void check_buttons(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.0}), Quat(1.0, 0.0, 0.0, 0.0));
    const auto device = open_peer(*peer);
    constexpr std::uint32_t order[] = {1u, 4u, 8u, 16u};
    for (int button = 0; button < peer->buttons; ++button) {
        peer->press(1u << button);
        CHECK(tick_until(*device, {},
                         [&](const DeviceSample& sample) { return sample.valid && sample.buttons == order[button]; }));
    }
    peer->press(0);
    if (peer->buttons > 0)
        CHECK(tick_until(*device, {}, [](const DeviceSample& sample) { return sample.buttons == 0; }));
}

void check_hang(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.0}), Quat(1.0, 0.0, 0.0, 0.0));
    auto device = open_peer(*peer);
    REQUIRE(tick_until(*device, {}, [](const DeviceSample& sample) { return sample.valid; }));
    peer->hang(true);
    const std::int64_t hung = steady_ns();
    REQUIRE(tick_until(*device, {}, [](const DeviceSample& sample) { return !sample.valid; }));
    CHECK(steady_ns() - hung < 40 * ms);  // 20 ms, one answer on the way, and a loaded machine
    const RealtimeViolations seen = watch([&] {
        for (int i = 0; i < 100; ++i) {
            device->acquire(1e-3);
            device->commit({});
        }
    });
    CHECK(seen.describe() == "none");
    const std::int64_t begin = steady_ns();
    device.reset();
    CHECK(steady_ns() - begin < 600 * ms);
    peer->hang(false);
    sleep_until(steady_ns() + 50 * ms);  // what came back takes itself down
}

void check_loss(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.0}), Quat(1.0, 0.0, 0.0, 0.0));
    const auto device = open_peer(*peer);
    const Wrench push{{0.75, 0.0, 0.0}, {}};
    REQUIRE(tick_until(*device, push, [&](const DeviceSample&) { return peer->given().force.x > 0.7; }));
    peer->unplug(true);
    CHECK(tick_until(*device, {}, [](const DeviceSample& sample) { return !sample.valid; }));
    sleep_until(steady_ns() + 50 * ms);
    CHECK_FALSE(device->acquire(1e-3).valid);
    peer->unplug(false);
    // Who goes on to want a large force gets none, and is told to let go.
    bool has_pushed = false, was_valid = false;
    for (int i = 0; i < 300; ++i) {
        device->commit(push);
        was_valid = was_valid || device->acquire(1e-3).valid;
        has_pushed = has_pushed || glm::length(peer->given().force) > 0.0;
        sleep_until(steady_ns() + ms);
    }
    CHECK_FALSE(has_pushed);
    CHECK(tick_until(*device, push,
                     [&](const DeviceSample& sample) { return sample.valid && peer->given().force.x > 0.7; }));
    CHECK(device->returns() >= 1);
}

void check_no_number(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.0}), Quat(1.0, 0.0, 0.0, 0.0));
    const auto device = open_peer(*peer);
    REQUIRE(tick_until(*device, {}, [](const DeviceSample& sample) { return sample.valid; }));
    peer->send_nan(true);
    CHECK(tick_until(*device, {}, [](const DeviceSample& sample) { return !sample.valid; }));
    peer->send_nan(false);
    CHECK(tick_until(*device, {}, [](const DeviceSample& sample) {
        return sample.valid && is_valid(sample.pose) && is_finite(sample.twist.linear);
    }));
}

void check_silence(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.0}), Quat(1.0, 0.0, 0.0, 0.0));
    auto device = open_peer(*peer);
    const Wrench push{{0.75, 0.0, 0.0}, {}};
    REQUIRE(tick_until(*device, push, [&](const DeviceSample&) { return peer->given().force.x > 0.7; }));
    const std::int64_t silent = steady_ns();
    while (glm::length(peer->given().force) > 0.0 && steady_ns() - silent < 1000 * ms)
        sleep_until(steady_ns() + ms / 4);
    CHECK(steady_ns() - silent < 30 * ms);  // 10 ms, a round, the line, and a loaded machine
    REQUIRE(tick_until(*device, push, [&](const DeviceSample&) { return peer->given().force.x > 0.7; }));
    device.reset();
    CHECK(wait_until([&] { return glm::length(peer->given().force) == 0.0; }, 100));
}

void check_burst(const PeerKind& kind) {
    const auto peer = kind.make();
    const Vec3 at = reachable(*peer, {0.012, -0.1, 0.0});
    peer->place(at, Quat(1.0, 0.0, 0.0, 0.0));
    const auto device = open_peer(*peer);
    REQUIRE(tick_until(*device, {}, [](const DeviceSample& sample) { return sample.valid; }));
    peer->burst();
    double fastest = 0.0;
    tick_until(*device, {}, [&, n = 0](const DeviceSample& sample) mutable {
        if (sample.valid) fastest = std::max(fastest, glm::length(sample.twist.linear));
        return ++n > 50;
    });
    CHECK(fastest < 0.01);
    CHECK(apart(device->acquire(1e-3).pose.position, at) <= std::max(peer->exact, 1e-9));
}

void check_reading(const PeerKind& kind) {
    const auto peer = kind.make();
    peer->place(reachable(*peer, {0.012, -0.1, 0.0}), Quat(1.0, 0.0, 0.0, 0.0));
    const auto device = open_peer(*peer, driver::OpenMode::reading);
    CHECK(tick_until(*device, {{0.75, 0.0, 0.0}, {}},
                     [n = 0](const DeviceSample& sample) mutable { return sample.valid && ++n > 40; }));
    CHECK(glm::length(peer->given().force) == 0.0);
    CHECK_FALSE(device->steps().empty());
}

/// In virtual time.
void check_without_line(void (*check)(const PeerKind&)) {
    const VirtualClock clock;
    for (const PeerKind& kind : peer_kinds(false)) {
        CAPTURE(kind.driver);
        check(kind);
    }
}

}  // namespace

TEST_CASE("units and axes of every driver are exact", "[virtual]") { check_without_line(check_units); }

TEST_CASE("forces along each axis reach every device in its own frame", "[virtual]") {
    check_without_line(check_forces);
}

TEST_CASE("no driver gives more than its device's limit, or a force that is no number", "[virtual]") {
    check_without_line(check_limits);
}

TEST_CASE("buttons of every driver are in the maker's order", "[virtual]") { check_without_line(check_buttons); }

TEST_CASE("a driver whose vendor hangs is invalid within 20 ms, delays no tick and is left alone at the end",
          "[virtual]") {
    check_without_line(check_hang);
}

TEST_CASE("a lost device is invalid, comes back by itself, and pushes only after small forces", "[virtual]") {
    check_without_line(check_loss);
}

TEST_CASE("a pose that is no number is invalid, and the next good one is valid", "[virtual]") {
    check_without_line(check_no_number);
}

TEST_CASE("an engine that falls silent leaves no force on any device", "[virtual]") {
    check_without_line(check_silence);
}

TEST_CASE("a burst leaves velocities as they are, and the newest pose is the one that counts", "[virtual]") {
    check_without_line(check_burst);
}

TEST_CASE("a device is read without enabling or giving a force", "[virtual]") { check_without_line(check_reading); }

TEST_CASE("a driver with a terminal or a socket does what every driver does", "[live]") {
    for (const PeerKind& kind : peer_kinds(true))
        for (const auto check : {check_units, check_forces, check_limits, check_buttons, check_hang, check_loss,
                                 check_no_number, check_silence, check_burst, check_reading}) {
            CAPTURE(kind.driver);
            check(kind);
        }
}
