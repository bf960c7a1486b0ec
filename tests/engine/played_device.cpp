// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/played_device.hpp"

#include "devices/haptic/operated.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>

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

constexpr std::size_t max_names = 8;
std::array<Performance*, max_names> performances{};

template <std::size_t slot>
std::unique_ptr<HapticDevice> open_played(Options&, const haptic::PathResolver&) {
    return std::make_unique<PlayedDevice>(*performances[slot]);
}

template <std::size_t... slots>
constexpr std::array<decltype(&open_played<0>), max_names> openers(std::index_sequence<slots...>) {
    return {open_played<slots>...};
}

}  // namespace

void play_as(const std::string& name, Performance& performance) {
    static std::map<std::string, std::size_t> slots;
    const std::size_t slot = slots.try_emplace(name, slots.size()).first->second;
    performances.at(slot) = &performance;
    haptic::add_haptic_driver({name, "a test plays it", openers(std::make_index_sequence<max_names>())[slot]});
}

}  // namespace tactus::test
