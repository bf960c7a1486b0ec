// SPDX-License-Identifier: Apache-2.0
// The thread of a driver in a process of its own, without the process: in virtual time it is late whenever a test
// wants.
#include "devices/hosted/driver_loop.hpp"

#include "devices/haptic/catalogue.hpp"
#include "dsp/core/clock.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/virtual_clock.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

using namespace tactus;
using test::VirtualClock;

namespace {

constexpr std::int64_t ms = 1'000'000;

struct Given {
    std::int64_t ns = 0;  ///< boot_ns
    double newton = 0.0;
};
std::vector<Given> given;

class NotingDevice final : public HapticDevice {
public:
    const DeviceInfo& info() const override { return info_; }
    void prepare(double) override {}
    DeviceSample acquire(double) noexcept override {
        DeviceSample sample;
        sample.counter = ++count_;
        sample.valid = true;
        return sample;
    }
    void commit(const Wrench& on_hand) noexcept override { given.push_back({boot_ns(), on_hand.force.x}); }

private:
    DeviceInfo info_{.name = "noting", .max_force = 10.0};
    std::int64_t count_ = 0;
};

/// An engine and the driver's thread of its device.
class Rig {
public:
    Rig() : block_(hosted::SharedBlock::create()) {
        given.clear();
        haptic::add_haptic_driver(
            {"noting", "a test reads what it was given", [](Options&, const haptic::PathResolver&) {
                 return std::unique_ptr<HapticDevice>(std::make_unique<NotingDevice>());
             }});
        REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends_) == 0);
        hosted::Words open{hosted::say_open, "noting", "device 'hand'"};
        hosted::append(open, SourceLocation{});
        hosted::send(ends_[0], open);
        hosted::send(ends_[0], {hosted::say_prepare, "0x1.0624dd2f1a9fcp-10", "0x1.0624dd2f1a9fcp-10"});
        loop_ = std::make_unique<hosted::DriverLoop>(*block_, ends_[1]);
        thread_ = std::thread([this] { loop_->run(); });
        sleep_for(10 * ms);
    }
    ~Rig() {
        loop_->end();
        thread_.join();
        for (const int end : ends_) ::close(end);
    }
    Rig(const Rig&) = delete;
    Rig& operator=(const Rig&) = delete;

    void commit(double newton) {
        last_commit_ns = boot_ns();
        block_->force.write(hosted::pack(Wrench{{newton, 0.0, 0.0}, {}}, last_commit_ns));
    }
    void tick(int count, double newton) {
        for (int i = 0; i < count; ++i) {
            commit(newton);
            sleep_for(ms);
        }
    }

    std::int64_t last_commit_ns = 0;

private:
    hosted::SharedBlock block_;
    int ends_[2] = {-1, -1};
    std::unique_ptr<hosted::DriverLoop> loop_;
    std::thread thread_;
};

double max_after(std::int64_t ns) {
    double most = 0.0;
    for (const Given& one : given)
        if (one.ns > ns) most = std::max(most, one.newton);
    return most;
}

// 15 ms until the force is gone, a round, and this late: 20 ms.
constexpr VirtualClock::Lateness very_late{3'900'000};

}  // namespace

TEST_CASE("an engine that falls silent leaves no force after 20 ms, however late the driver's thread wakes up",
          "[virtual]") {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        CAPTURE(seed);
        VirtualClock clock({}, seed);
        Rig rig;
        rig.tick(20, 0.0);
        rig.tick(30, 4.0);
        REQUIRE(given.back().newton == 4.0);
        clock.set_lateness(very_late);
        rig.commit(4.0);
        sleep_for(60 * ms);
        if (VirtualClock::is_virtual()) CHECK(max_after(rig.last_commit_ns + 20 * ms) == 0.0);
        const auto silent = std::ranges::upper_bound(given, rig.last_commit_ns, {}, &Given::ns);
        CHECK(std::ranges::is_sorted(silent, given.end(), std::ranges::greater{}, &Given::newton));
    }
}

TEST_CASE("an engine that was silent for a moment gives no force without small ones first", "[virtual]") {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(seed);
        VirtualClock clock({}, seed);
        Rig rig;
        rig.tick(20, 0.0);
        rig.tick(30, 4.0);
        sleep_for(50 * ms);
        const std::int64_t gone = boot_ns();
        rig.tick(100, 4.0);
        CHECK(max_after(gone) == 0.0);
        rig.tick(10, 0.0);
        rig.tick(10, 4.0);
        CHECK(max_after(gone) == 4.0);
    }
}

TEST_CASE("forces from before a suspension, or from before the machine stood still, are none afterwards", "[virtual]") {
    if (!VirtualClock::is_virtual()) return test::skip("ThreadSanitizer: threads are real");
    for (const bool suspends : {true, false}) {
        CAPTURE(suspends);
        VirtualClock clock;
        Rig rig;
        rig.tick(20, 0.0);
        rig.tick(30, 4.0);
        if (suspends) clock.suspend_machine(3'600'000 * ms);
        else clock.stop_machine(200 * ms);
        const std::int64_t back = boot_ns();
        sleep_for(5 * ms);
        rig.tick(100, 4.0);
        CHECK(max_after(back) == 0.0);
        rig.tick(10, 0.0);
        rig.tick(10, 4.0);
        CHECK(max_after(back) == 4.0);
    }
}
