// SPDX-License-Identifier: Apache-2.0
// A device host with one driver more, "watched": it writes down each force that it is given, and fails as it is told.
#include "devices/haptic/catalogue.hpp"
#include "devices/hosted/device_host.hpp"
#include "dsp/core/clock.hpp"
#include "tests/support/force_log.hpp"

#include <unistd.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace {

using namespace tactus;

[[noreturn]] void hang() {
    for (;;) ::pause();
}

struct Behaviour {
    std::string log, fault;
    int at = 0;
};

class WatchedDevice final : public HapticDevice {
public:
    explicit WatchedDevice(const Behaviour& behaviour) : behaviour_(behaviour), log_(behaviour.log) {
        info_.name = "watched";
        info_.max_force = behaviour.fault == "endless limit" ? std::numeric_limits<double>::infinity() : 20.0;
        info_.max_torque = 1.0;
        info_.damping = 4.0;
        info_.actuates_torque = true;
        log_.note_open();
        if (is("hang in open", 0)) hang();
    }
    ~WatchedDevice() override {
        if (is("hang in close", 0)) hang();
        log_.note_closed();
    }

    const DeviceInfo& info() const override { return info_; }
    void prepare(double) override {
        if (is("hang in prepare", 0)) hang();
        if (is("fail in prepare", 0)) throw Error("the motors are cold");
    }
    DeviceSample acquire(double) noexcept override {
        ++count_;
        if (is("hang in acquire", behaviour_.at)) hang();
        DeviceSample sample;
        sample.counter = count_;
        sample.valid = true;
        // Presses 5 mm deep and comes back, once a second, so that forces can engage at any time.
        const double t = static_cast<double>(boot_ns() - begin_ns_) * 1e-9;
        sample.pose.position.z = -2.5e-3 * (1.0 - std::cos(2.0 * std::numbers::pi * t));
        if (is("no pose", behaviour_.at)) sample.pose.position.x = std::nan("");
        return sample;
    }
    void commit(const Wrench& on_hand) noexcept override {
        log_.add(glm::length(on_hand.force));
        if (is("hang in commit", behaviour_.at)) hang();
    }

private:
    bool is(const char* fault, int from) const { return behaviour_.fault == fault && count_ >= from; }

    Behaviour behaviour_;
    test::ForceLog log_;
    DeviceInfo info_;
    std::int64_t begin_ns_ = boot_ns();
    int count_ = 0;
};

std::unique_ptr<HapticDevice> open_watched(Options& options, const haptic::PathResolver&) {
    Behaviour behaviour;
    behaviour.log = options.text("log", "");
    behaviour.fault = options.text("fault", "none");
    behaviour.at = static_cast<int>(options.quantity("at", "0", "0", "1000000"));
    return std::make_unique<WatchedDevice>(behaviour);
}

}  // namespace

int main() {
    haptic::add_haptic_driver({"watched", "a test watches what it is given", open_watched, true});
    return hosted::run_device_host();
}
