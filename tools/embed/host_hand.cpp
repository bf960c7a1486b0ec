// SPDX-License-Identifier: Apache-2.0
#include "tools/embed/host_hand.hpp"

#include "devices/haptic/catalogue.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"

#include <map>
#include <mutex>
#include <utility>

namespace tactus::embed {

namespace {

constexpr std::int64_t max_silence_ns = 20'000'000;

struct Links {
    std::mutex lock;
    std::map<std::string, HostHand*> hands;
    std::int64_t made = 0;
};

Links& links() {
    static Links all;
    return all;
}

}  // namespace

class HostDevice final : public HapticDevice {
public:
    explicit HostDevice(HostHand& hand) : hand_(hand) {}

    const DeviceInfo& info() const override { return hand_.info_; }

    void prepare(double) override {
        hand_.felt_.write({});
        counter_ = 0;
        begun_ns_ = steady_ns();
    }

    DeviceSample acquire(double) noexcept override {
        HostMotion now = motion_;
        std::uint64_t number = 0;
        if (hand_.wanted_.read(now, number) && number != number_) {
            number_ = number;
            motion_ = now;
            ++counter_;
        }
        DeviceSample sample{motion_.pose, motion_.twist, static_cast<std::uint32_t>(motion_.buttons), counter_,
                            motion_.is_invalid == 0 && is_good(motion_.pose, motion_.twist)};
        if (hand_.real_time_) sample.late = steady_ns() - (number_ == 0 ? begun_ns_ : motion_.at_ns) > max_silence_ns;
        return sample;
    }

    void commit(const Wrench& on_hand) noexcept override { hand_.felt_.write(on_hand); }

private:
    HostHand& hand_;
    HostMotion motion_;
    std::uint64_t number_ = 0;
    std::int64_t counter_ = 0, begun_ns_ = 0;
};

HostHand::HostHand(DeviceInfo info, bool real_time) : info_(std::move(info)), real_time_(real_time) {
    Links& all = links();
    const std::lock_guard hold(all.lock);
    link_ = std::to_string(++all.made);
    all.hands[link_] = this;
}

HostHand::~HostHand() {
    Links& all = links();
    const std::lock_guard hold(all.lock);
    all.hands.erase(link_);
}

void HostHand::move(HostMotion motion) noexcept {
    motion.at_ns = steady_ns();
    wanted_.write(motion);
}

Wrench HostHand::force() const noexcept {
    Wrench wrench;
    std::uint64_t number = 0;
    // Eight tries that all met the writer: the writer is stuck, and a force that nobody vouches for is none.
    return felt_.read(wrench, number) ? wrench : Wrench{};
}

void add_host_driver() {
    static std::once_flag once;
    std::call_once(once, [] {
        haptic::add_haptic_driver({"host", "a device that the program moves in which the patch is embedded",
                                   [](Options& options, const haptic::PathResolver&) -> std::unique_ptr<HapticDevice> {
                                       const std::string link = options.text("link", "");
                                       Links& all = links();
                                       const std::lock_guard hold(all.lock);
                                       const auto found = all.hands.find(link);
                                       if (found == all.hands.end())
                                           throw Error(
                                               "the driver 'host' is for programs in which a patch is embedded "
                                               "(tactus_attach_hand)");
                                       return std::make_unique<HostDevice>(*found->second);
                                   }});
    });
}

}  // namespace tactus::embed
