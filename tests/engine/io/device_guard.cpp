// SPDX-License-Identifier: Apache-2.0
#include "engine/io/device_guard.hpp"

#include "dsp/core/clock.hpp"
#include "tests/support/catch.hpp"

#include <atomic>
#include <thread>

using namespace tactus;
using control::Fault, control::ForceState;

TEST_CASE("of more faults than are kept the newest are told and all are counted") {
    io::DeviceGuard guard;
    for (int n = 0; n < 100; ++n) {
        guard.note(Fault::late_commit, ForceState::returns, 10 * n, n);
        if (n < 99) guard.note(Fault::none, ForceState::on, 10 * n + 5, 0.0);
    }
    const auto faults = guard.faults();
    REQUIRE(faults.size() == io::DeviceGuard::max_faults);
    for (std::size_t i = 0; i < faults.size(); ++i) {
        const auto number = static_cast<std::int64_t>(i + 36);
        CHECK(faults[i].number == number);
        CHECK(faults[i].tick == 10 * number);
        CHECK(faults[i].force_N == static_cast<double>(number));
        CHECK(faults[i].over == (number < 99 ? 10 * number + 5 : -1));
    }
}

TEST_CASE("a fault that takes the place of another ends it") {
    io::DeviceGuard guard;
    guard.note(Fault::late_commit, ForceState::returns, 10, 4.0);
    guard.note(Fault::not_finite, ForceState::never, 20, 0.0);
    const auto faults = guard.faults();
    REQUIRE(faults.size() == 2);
    CHECK(faults[0].over == 20);
    CHECK(faults[1].reason == Fault::not_finite);
    CHECK(faults[1].over == -1);
}

namespace {

class Still final : public HapticDevice {
public:
    const DeviceInfo& info() const override { return stated; }
    void prepare(double) override {}
    DeviceSample acquire(double) noexcept override { return {}; }
    void commit(const Wrench& on_hand) noexcept override { last = on_hand; }

    Wrench last;
    DeviceInfo stated;
};

}  // namespace

TEST_CASE("a device that no node drives for a while is no late one when it is driven again") {
    constexpr std::int64_t ms = 1'000'000;
    for (const bool is_told : {true, false}) {
        INFO((is_told ? "on purpose" : "its ticks stay away"));
        io::DeviceGuard guard;
        guard.set_limit(3 * ms);
        Still device;
        const std::int64_t begin = steady_ns();
        std::int64_t now = begin;
        guard.commit(device, {Vec3(1.0, 0.0, 0.0), {}}, now);
        CHECK(device.last.force.x == 1.0);
        if (is_told) guard.set_driven(false);
        for (; now < begin + 2000 * ms; now += ms) guard.poll(device, now);
        CHECK(device.last.force.x == 0.0);
        if (is_told) guard.set_driven(true);
        CHECK(guard.was_taken() == !is_told);
        // The first force of a node that comes in anew is none.
        for (int n = 0; n < 20; ++n, now += ms) {
            guard.commit(device, {}, now);
            guard.poll(device, now);
            if (is_told) CHECK_FALSE(guard.was_taken());
        }
        guard.was_taken();
        guard.commit(device, {Vec3(2.0, 0.0, 0.0), {}}, steady_ns());
        CHECK_FALSE(guard.was_taken());
        CHECK(device.last.force.x == 2.0);
    }
}

TEST_CASE("the watchdog leaves a device without motors its force until the run ends") {
    constexpr std::int64_t ms = 1'000'000;
    io::DeviceGuard guard;
    guard.set_limit(3 * ms);
    Still device;
    device.stated.without_motors = true;
    std::int64_t now = steady_ns();
    guard.commit(device, {Vec3(1.0, 0.0, 0.0), {}}, now);
    for (int n = 0; n < 200; ++n) guard.poll(device, now += ms);
    CHECK(device.last.force.x == 1.0);
    CHECK_FALSE(guard.was_taken());
    guard.retire();
    for (int n = 0; n < 20; ++n) guard.poll(device, now += ms);
    CHECK(device.last.force.x == 0.0);
    CHECK(guard.is_at_rest());
}

TEST_CASE("whoever reads faults while they are written sees each whole") {
    io::DeviceGuard guard;
    std::atomic<bool> is_over{false};
    std::thread ticks([&] {
        for (int n = 0; n < 20'000; ++n) {
            guard.note(Fault::late_commit, ForceState::returns, 2 * n, n);
            guard.note(Fault::none, ForceState::on, 2 * n + 1, 0.0);
        }
        is_over = true;
    });
    std::int64_t wrong = 0;
    while (!is_over)
        for (const io::DeviceFault& fault : guard.faults())
            wrong += fault.tick != 2 * fault.number || fault.force_N != static_cast<double>(fault.number) ||
                     (fault.over >= 0 && fault.over != fault.tick + 1);
    ticks.join();
    CHECK(wrong == 0);
}
