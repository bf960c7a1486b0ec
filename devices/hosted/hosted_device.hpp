// SPDX-License-Identifier: Apache-2.0
// A device whose driver runs in a process of its own: what the engine has of it.
#pragma once

#include "devices/haptic/catalogue.hpp"
#include "devices/hosted/block.hpp"
#include "devices/hosted/host_process.hpp"
#include "devices/hosted/placement.hpp"
#include "graph/node/device.hpp"
#include "graph/node/options.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hosted {

/// A device as a patch declares it.
struct DeviceRequest {
    std::string driver, owner;  ///< owner: "device 'hand'", for messages
    std::vector<OptionText> settings;
    SourceLocation where;
};

class HostedDevice final : public HapticDevice, public haptic::PulledDevice {
public:
    /// Starts the process and waits until the driver has opened its device. Throws Error with the driver's text, or when
    /// it takes longer than placement.open_timeout.
    HostedDevice(const DeviceRequest& request, const Placement& placement, const haptic::PathResolver& resolve);
    /// No force; asks the process to end, waits at most 100 ms, kills it.
    ~HostedDevice() override;

    const DeviceInfo& info() const override { return info_; }
    /// Throws Error with the driver's text, or when it takes longer than open_timeout.
    void prepare(double period_s) override;
    /// The newest sample. Not valid when it is older than 20 ms or three rounds of the process, or while the process holds
    /// forces back. Wait-free, no system call.
    DeviceSample acquire(double elapsed_s) noexcept override;
    /// Wait-free, no system call.
    void commit(const Wrench& on_hand) noexcept override;
    void drive(const MotorDrive& wanted) noexcept override;
    std::shared_ptr<const haptic::PullLink> pull() const noexcept override { return pull_; }

    /// Control thread of a live run, at least every half second: says that the engine lives, and looks after the process.
    /// One that was silent for 500 ms is killed. Why the device is lost, for people, or "". Does not wait.
    const std::string& service() noexcept;
    const std::string& loss() const noexcept { return loss_; }

    /// boot_ns of the commit whose force the device had at the sample acquired last; 0: none.
    std::int64_t answered_ns() const noexcept { return newest_.answers_ns; }
    pid_t process() const noexcept { return process_->id(); }

private:
    void pass_pull() noexcept;
    class Socket {
    public:
        Socket();
        ~Socket() { close(); }
        Socket(const Socket&) = delete;
        Socket& operator=(const Socket&) = delete;
        void close() noexcept;
        void close_theirs() noexcept;
        int ours = -1, theirs = -1;
    };

    void wait_for(const char* reply, const haptic::PathResolver& resolve);
    [[noreturn]] void fail(const std::string& message) const;
    std::string how_it_ended() const;

    std::string owner_;
    SourceLocation where_;
    Placement placement_;
    SharedBlock block_;
    Socket socket_;
    std::unique_ptr<HostProcess> process_;
    DeviceInfo info_;
    double own_delay_s_ = 0.0;  // of the device without its process
    std::int64_t limit_ns_ = 20'000'000;
    const std::shared_ptr<haptic::PullLink> pull_ = std::make_shared<haptic::PullLink>();
    // Thread of the tick.
    SampleRecord newest_;
    std::uint64_t number_ = 0, pull_number_ = 0;
    // Control thread.
    std::int64_t published_ns_ = 0, heard_ns_ = 0;
    std::string loss_;
};

/// Opens a device where its options say: in this process, or in one of its own. Throws Error.
std::unique_ptr<HapticDevice> open_placed(const DeviceRequest& request, const haptic::PathResolver& resolve);

/// Opens it in this process whatever its options say, for runs that are not live. Throws Error.
std::unique_ptr<HapticDevice> open_here(const DeviceRequest& request, const haptic::PathResolver& resolve);

/// s that the process of its own, if the options ask for one, adds to the delay of a device whose nodes have `period_s`.
/// Throws Error on options that cannot be read.
double added_latency_s(const DeviceRequest& request, double period_s);

/// What the driver of hardware says of it without opening it. Throws Error on options that cannot be read.
haptic::HardwareOutline describe_here(const DeviceRequest& request, const haptic::PathResolver& resolve);

}  // namespace tactus::hosted
