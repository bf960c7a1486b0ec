// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/passivity/thrown_device.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::analysis {
namespace {

class ThrownDevice final : public HapticDevice {
public:
    ThrownDevice(const Throw& thrown, Flight& flight)
        : thrown_(thrown),
          flight_(flight),
          device_(thrown.model, {.mass = thrown.mass,
                                 .inertia = 1e-3,
                                 .stiffness = 0.0,
                                 .damping = 0.0,
                                 .angular_stiffness = 0.0,
                                 .angular_damping = 0.0}) {
        info_.name = "thrown";
        info_.max_force = thrown.model.max_force;
        info_.resolution = thrown.model.resolution;
        info_.angular_resolution = thrown.model.angular_resolution;
        info_.delay = thrown.model.delay;
        info_.senses_rotation = true;
    }

    const DeviceInfo& info() const override { return info_; }

    void prepare(double) override {
        device_.place({{0.0, 0.0, thrown_.height}, {1, 0, 0, 0}});
        flight_ = {};
        force_ = {};
        time_ = 0.0;
        count_ = 0;
    }

    DeviceSample acquire(double elapsed_s) noexcept override {
        const bool stands = time_ < thrown_.at_s;
        time_ += elapsed_s;
        if (stands && time_ >= thrown_.at_s) device_.launch({{0.0, 0.0, -thrown_.speed}, {}});
        if (!stands) fly(elapsed_s);
        return {device_.pose(), device_.twist(), 0u, ++count_, true};
    }

    void commit(const Wrench& on_hand) noexcept override { force_ = {on_hand.force, {}}; }

private:
    void fly(double elapsed_s) noexcept {
        const double before = energy();
        const auto alone = [](double, const Wrench&, const Pose& hand) { return simulate::Intention{hand, {}}; };
        device_.advance(alone, force_, elapsed_s);
        const bool pushes = glm::length(force_.force) > 0.0 || glm::length(device_.acting().force) > 0.0;
        if (pushes && !flight_.touched) {
            flight_.touched = true;
            flight_.before = before;
        }
        free_ = pushes ? 0 : free_ + 1;
        if (!flight_.touched || flight_.left) return;
        if (free_ == 0) flight_.after = energy();
        flight_.left = free_ > 20;
    }

    double energy() const noexcept {
        const simulate::Hand& hand = device_.truth();
        return 0.5 * hand.dynamics.mass * glm::dot(hand.twist.linear, hand.twist.linear);
    }

    Throw thrown_;
    Flight& flight_;
    simulate::ModelledDevice device_;
    DeviceInfo info_;
    Wrench force_;
    double time_ = 0.0;
    std::int64_t count_ = 0;
    int free_ = 0;
};

}  // namespace

std::unique_ptr<HapticDevice> open_thrown(const Throw& thrown, Flight& flight) {
    return std::make_unique<ThrownDevice>(thrown, flight);
}

}  // namespace tactus::analysis
