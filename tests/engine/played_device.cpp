// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/played_device.hpp"

#include "devices/haptic/operated.hpp"

#include <map>
#include <memory>

namespace tactus::test {

namespace {

class PlayedDevice final : public HapticDevice {
public:
    explicit PlayedDevice(Performance& performance) : performance_(performance) {}

    const DeviceInfo& info() const override { return performance_.info; }
    void prepare(double) override {}
    DeviceSample acquire(double elapsed_s) noexcept override {
        return performance_.acquire(count_++, elapsed_s, force_.get());
    }
    void commit(const Wrench& on_hand) noexcept override {
        force_.set(on_hand);
        if (performance_.commit) performance_.commit(on_hand);
    }

private:
    Performance& performance_;
    std::int64_t count_ = 0;
    haptic::SharedWrench force_;
};

Performance* performances[2] = {};

template <int slot>
std::unique_ptr<HapticDevice> open_played(Options&, const haptic::PathResolver&) {
    return std::make_unique<PlayedDevice>(*performances[slot]);
}

}  // namespace

void play_as(const std::string& name, Performance& performance) {
    static std::map<std::string, int> slots;
    const int slot = slots.try_emplace(name, static_cast<int>(slots.size()) % 2).first->second;
    performances[slot] = &performance;
    haptic::add_haptic_driver({name, "a test plays it", slot == 0 ? open_played<0> : open_played<1>});
}

}  // namespace tactus::test
