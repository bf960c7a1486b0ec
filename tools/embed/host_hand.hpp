// SPDX-License-Identifier: Apache-2.0
// Driver "host": a device that the program moves in which the patch is embedded. The program's thread and the tick exchange
// the newest motion and force; neither waits.
#pragma once

#include "devices/hosted/seqlock.hpp"
#include "graph/node/device.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace tactus::embed {

/// What the program says of the hand, device frame.
struct HostMotion {
    Pose pose;
    Twist twist;
    std::int64_t buttons = 0;  ///< bits of DeviceSample::buttons
    std::int64_t is_invalid = 0;
    std::int64_t at_ns = 0;  ///< steady clock
};

/// One device of one run. It must outlive the run.
class HostHand {
public:
    /// `real_time`: a hand that was not moved for 20 ms is late, as after a late tick, so that its force fades.
    HostHand(DeviceInfo info, bool real_time);
    ~HostHand();
    HostHand(const HostHand&) = delete;
    HostHand& operator=(const HostHand&) = delete;

    /// The program's thread. Wait-free.
    void move(HostMotion motion) noexcept;
    Wrench force() const noexcept;

    /// What stands for it in a patch: the value of the option `link` of the driver.
    const std::string& link() const { return link_; }

private:
    friend class HostDevice;
    DeviceInfo info_;
    bool real_time_;
    std::string link_;
    hosted::Seqlock<HostMotion> wanted_;
    hosted::Seqlock<Wrench> felt_;
};

/// Makes the driver known. Any number of times.
void add_host_driver();

}  // namespace tactus::embed
